// node validate_glb.js FILE: what Khronos' validator says against a GLB; status 1 where that is an error or a warning.
const fs = require("fs");
const validator = require("gltf-validator");

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])), { maxIssues: 20 }).then((report) => {
  const { numErrors, numWarnings, messages } = report.issues;
  if (numErrors + numWarnings > 0) {
    console.log(JSON.stringify(messages.filter((message) => message.severity < 2)));
    process.exit(1);
  }
});
