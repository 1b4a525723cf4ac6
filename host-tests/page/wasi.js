// The system of a program that runs in a worker: the part of WASI preview 1 that the program asks for
// (github.com/WebAssembly/WASI, legacy/preview1/docs.md). It has one folder with the dropped files, which are read piece by
// piece and never kept in memory, and with the files that the program writes, which are.
"use strict";

const ERRNO = { none: 0, badFile: 8, exists: 20, invalid: 28, noEntry: 44, notSupported: 58 };
const FOLDER = 3;
const KIND = { folder: 3, file: 4, character: 2 };
const OPEN = { create: 1, exclusive: 4, truncate: 8 };
/** The bytes that are read of a dropped file at once. */
const PIECE = 1 << 20;

/** Thrown to end a program. */
class Exit {
  constructor(status) {
    this.status = status;
  }
}

/** A file that was dropped. */
class Dropped {
  constructor(blob, told) {
    this.blob = blob;
    this.told = told;
    this.from = 0;
    this.piece = new Uint8Array();
  }

  get size() {
    return this.blob.size;
  }

  /** Copies bytes from a place on, and returns their number. */
  read(at, into) {
    const inside = at >= this.from && at < this.from + this.piece.length;
    if (!inside) {
      this.from = at;
      this.told(at / this.blob.size);
      this.piece = new Uint8Array(new FileReaderSync().readAsArrayBuffer(this.blob.slice(at, at + PIECE)));
    }
    const part = this.piece.subarray(at - this.from, at - this.from + into.length);
    into.set(part);
    return part.length;
  }

  write() {
    return false;
  }
}

/** Bytes that the page gave. */
class Held {
  constructor(bytes) {
    this.bytes = bytes;
    this.size = bytes.length;
  }

  read(at, into) {
    const part = this.bytes.subarray(Math.min(at, this.size), Math.min(at + into.length, this.size));
    into.set(part);
    return part.length;
  }

  write() {
    return false;
  }
}

/** A file that the program writes. */
class Written {
  constructor() {
    this.bytes = new Uint8Array(PIECE);
    this.size = 0;
  }

  read(at, into) {
    const part = this.bytes.subarray(Math.min(at, this.size), Math.min(at + into.length, this.size));
    into.set(part);
    return part.length;
  }

  write(at, from) {
    const end = at + from.length;
    if (end > this.bytes.length) {
      const larger = new Uint8Array(Math.max(2 * this.bytes.length, end));
      larger.set(this.bytes.subarray(0, this.size));
      this.bytes = larger;
    }
    this.bytes.set(from, at);
    this.size = Math.max(this.size, end);
    return true;
  }

  content() {
    return this.bytes.slice(0, this.size);
  }
}

/**
 * Runs a module with arguments and files by name, each a File or bytes. Returns its exit status, what it printed, and the files that it wrote.
 * `told` is called with the share of a file that has been read.
 */
function runProgram(module, args, files, told) {
  const text = new TextEncoder();
  const given = (one) => (one instanceof Uint8Array ? new Held(one) : new Dropped(one, told));
  const entries = new Map(Array.from(files, ([name, one]) => [name, given(one)]));
  const printed = [new Written(), new Written()];
  const opened = new Map();
  // No colours, and no terminal.
  const environment = ["NO_COLOR=1"];
  let memory = null;
  let next = FOLDER + 1;

  const view = () => new DataView(memory.buffer);
  const bytes = (at, length) => new Uint8Array(memory.buffer, at, length);
  const string = (at, length) => new TextDecoder().decode(bytes(at, length).slice());
  const strings = (list) => ({
    sizes: (count, size) => {
      view().setUint32(count, list.length, true);
      view().setUint32(size, list.reduce((sum, one) => sum + text.encode(one).length + 1, 0), true);
      return ERRNO.none;
    },
    get: (places, at) => {
      for (const one of list) {
        view().setUint32(places, at, true);
        const encoded = text.encode(`${one}\0`);
        bytes(at, encoded.length).set(encoded);
        places += 4;
        at += encoded.length;
      }
      return ERRNO.none;
    },
  });
  /** The pieces of memory that a call lists. */
  const pieces = (list, count) =>
    Array.from({ length: count }, (_, at) => {
      const place = list + 8 * at;
      return bytes(view().getUint32(place, true), view().getUint32(place + 4, true));
    });
  const status = (at, kind, size) => {
    bytes(at, 64).fill(0);
    view().setUint8(at + 16, kind);
    view().setBigUint64(at + 24, 1n, true);
    view().setBigUint64(at + 32, BigInt(size), true);
    return ERRNO.none;
  };
  /** Reads into pieces from a place on, and returns the number of bytes. */
  const readAt = (file, place, list, count) => {
    let read = 0;
    for (const piece of pieces(list, count)) {
      let filled = 0;
      while (filled < piece.length) {
        const part = file.read(place + read, piece.subarray(filled));
        if (part === 0) return read;
        filled += part;
        read += part;
      }
    }
    return read;
  };

  const own = strings(args);
  const variables = strings(environment);
  const calls = {
    args_sizes_get: own.sizes,
    args_get: own.get,
    environ_sizes_get: variables.sizes,
    environ_get: variables.get,
    clock_res_get: (clock, out) => {
      view().setBigUint64(out, 1000n, true);
      return ERRNO.none;
    },
    clock_time_get: (clock, precision, out) => {
      const now = clock === 0 ? Date.now() : performance.now();
      view().setBigUint64(out, BigInt(Math.round(1e6 * now)), true);
      return ERRNO.none;
    },
    random_get: (at, length) => {
      crypto.getRandomValues(bytes(at, length));
      return ERRNO.none;
    },
    proc_exit: (code) => {
      throw new Exit(code);
    },
    sched_yield: () => ERRNO.none,
    fd_prestat_get: (fd, out) => {
      if (fd !== FOLDER) return ERRNO.badFile;
      view().setUint32(out, 0, true);
      view().setUint32(out + 4, 1, true);
      return ERRNO.none;
    },
    fd_prestat_dir_name: (fd, at) => {
      bytes(at, 1)[0] = "/".charCodeAt(0);
      return ERRNO.none;
    },
    fd_fdstat_get: (fd, out) => {
      const kind = fd === FOLDER ? KIND.folder : fd < FOLDER ? KIND.character : KIND.file;
      bytes(out, 24).fill(0);
      view().setUint8(out, kind);
      // Everything is allowed.
      view().setBigUint64(out + 8, ~0n & 0xffffffffffffffffn, true);
      view().setBigUint64(out + 16, ~0n & 0xffffffffffffffffn, true);
      return ERRNO.none;
    },
    fd_fdstat_set_flags: () => ERRNO.none,
    fd_filestat_get: (fd, out) => {
      if (fd === FOLDER) return status(out, KIND.folder, 0);
      if (fd < FOLDER) return status(out, KIND.character, 0);
      const one = opened.get(fd);
      return one ? status(out, KIND.file, one.file.size) : ERRNO.badFile;
    },
    fd_read: (fd, list, count, out) => {
      const one = opened.get(fd);
      if (fd !== 0 && !one) return ERRNO.badFile;
      const read = one ? readAt(one.file, one.place, list, count) : 0;
      if (one) one.place += read;
      view().setUint32(out, read, true);
      return ERRNO.none;
    },
    fd_pread: (fd, list, count, offset, out) => {
      const one = opened.get(fd);
      if (!one) return ERRNO.badFile;
      view().setUint32(out, readAt(one.file, Number(offset), list, count), true);
      return ERRNO.none;
    },
    fd_write: (fd, list, count, out) => {
      const one = fd === 1 || fd === 2 ? { file: printed[fd - 1], place: printed[fd - 1].size } : opened.get(fd);
      if (!one) return ERRNO.badFile;
      let written = 0;
      for (const piece of pieces(list, count)) {
        if (!one.file.write(one.place, piece)) return ERRNO.badFile;
        one.place += piece.length;
        written += piece.length;
      }
      view().setUint32(out, written, true);
      return ERRNO.none;
    },
    fd_seek: (fd, offset, whence, out) => {
      const one = opened.get(fd);
      if (!one) return ERRNO.badFile;
      const from = [0, one.place, one.file.size][whence];
      const place = from + Number(offset);
      if (place < 0) return ERRNO.invalid;
      one.place = place;
      view().setBigUint64(out, BigInt(place), true);
      return ERRNO.none;
    },
    fd_tell: (fd, out) => {
      const one = opened.get(fd);
      if (!one) return ERRNO.badFile;
      view().setBigUint64(out, BigInt(one.place), true);
      return ERRNO.none;
    },
    fd_close: (fd) => {
      opened.delete(fd);
      return ERRNO.none;
    },
    fd_sync: () => ERRNO.none,
    fd_datasync: () => ERRNO.none,
    fd_advise: () => ERRNO.none,
    path_open: (folder, lookup, path, length, flags, rights, inherited, fdFlags, out) => {
      const name = string(path, length);
      let file = entries.get(name);
      if (name === "." || name === "") {
        view().setUint32(out, FOLDER, true);
        return ERRNO.none;
      }
      if (file && flags & OPEN.exclusive) return ERRNO.exists;
      if (!file && !(flags & OPEN.create)) return ERRNO.noEntry;
      if (!file || flags & OPEN.truncate) {
        file = new Written();
        entries.set(name, file);
      }
      opened.set(next, { file, place: 0 });
      view().setUint32(out, next, true);
      next += 1;
      return ERRNO.none;
    },
    path_filestat_get: (folder, flags, path, length, out) => {
      const name = string(path, length);
      if (name === "." || name === "") return status(out, KIND.folder, 0);
      const file = entries.get(name);
      return file ? status(out, KIND.file, file.size) : ERRNO.noEntry;
    },
    path_rename: (folder, path, length, toFolder, toPath, toLength) => {
      const name = string(path, length);
      const file = entries.get(name);
      if (!file) return ERRNO.noEntry;
      entries.delete(name);
      entries.set(string(toPath, toLength), file);
      return ERRNO.none;
    },
    path_unlink_file: (folder, path, length) => (entries.delete(string(path, length)) ? ERRNO.none : ERRNO.noEntry),
    path_readlink: () => ERRNO.invalid,
  };
  const wanted = WebAssembly.Module.imports(module);
  const imports = wanted.map(({ name }) => [name, calls[name] ?? (() => ERRNO.notSupported)]);
  const instance = new WebAssembly.Instance(module, { wasi_snapshot_preview1: Object.fromEntries(imports) });
  memory = instance.exports.memory;
  let code = 0;
  try {
    instance.exports._start();
  } catch (error) {
    if (!(error instanceof Exit)) throw error;
    code = error.status;
  }
  const written = Array.from(entries).filter(([, file]) => file instanceof Written);
  const [output, errors] = printed.map((file) => new TextDecoder().decode(file.content()));
  return { status: code, output, errors, files: written.map(([name, file]) => [name, file.content()]) };
}
