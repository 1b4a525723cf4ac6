// Runs one command of the program, beside the page, so that the page answers while a log is read.
"use strict";

onmessage = ({ data: { module, args, files } }) => {
  try {
    postMessage(runProgram(module, args, files, (share) => postMessage({ share })));
  } catch (error) {
    // A trap: what the program cannot do here, or memory that the browser does not give.
    postMessage({ status: 2, output: "", errors: `the program stopped: ${error}`, files: [] });
  }
};
