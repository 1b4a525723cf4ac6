// The page on which effects are tried, which a report carries. It opens beside the report.
"use strict";

const [beforeRecords, behindRecords] = JSON.parse(document.getElementById("explorer").textContent);
const recordsToTry = document.getElementById("session").textContent;
const tryLink = document.getElementById("try");
tryLink.href = URL.createObjectURL(new Blob([beforeRecords, recordsToTry, behindRecords], { type: "text/html" }));
tryLink.hidden = false;
