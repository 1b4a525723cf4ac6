// Runs commands of the program, one after the other, beside the page, so that the page answers while a log is read.
"use strict";

let module = null;

onmessage = ({ data }) => {
  if (data.module) {
    module = data.module;
    return;
  }
  const { id, args, files } = data;
  try {
    postMessage({ id, ended: runProgram(module, args, files, (share) => postMessage({ id, share })) });
  } catch (error) {
    // A trap: what the program cannot do here, or memory that the browser does not give.
    postMessage({ id, ended: { status: 2, output: "", errors: `the program stopped: ${error}`, files: [] } });
  }
};
