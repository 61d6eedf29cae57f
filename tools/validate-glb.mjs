// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Holds .glb files against the Khronos glTF validator (npm's gltf-validator, fetched by `tools/get-assets validator`).
//
//   node tools/validate-glb.mjs a.glb b.glb …     prints every error and warning; exit 1 where a file has an error
//
// Exit 3 where the validator is not there.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';

const root = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const library = path.join(root, 'assets', 'validator', 'index.js');
if (!fs.existsSync(library)) {
  console.error('validate-glb: the validator is not there; `tools/get-assets validator` fetches it');
  process.exit(3);
}
const validator = createRequire(import.meta.url)(library);
const severities = ['error', 'warning', 'information', 'hint'];
let broken = false;
for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: file, maxIssues: 100 });
  const { numErrors, numWarnings } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings`);
  for (const issue of report.issues.messages) {
    if (issue.severity > 1 && !process.env.VERBOSE) continue;
    console.log(`  ${severities[issue.severity]}: ${issue.pointer ?? ''}: ${issue.message} (${issue.code})`);
  }
  broken = broken || numErrors > 0;
}
process.exit(broken ? 1 : 0);
