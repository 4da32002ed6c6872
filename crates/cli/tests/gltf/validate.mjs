// Reads GLB files with the glTF validator of Khronos, and fails if it finds an error or a warning in one of them.
//
//     npm ci && node validate.mjs FILE.glb…
//
// Warnings of the kinds in `EXPECTED` are counted only: each has its reason there.
import { readFileSync } from 'node:fs';
import validator from 'gltf-validator';

/** Kinds that are no faults of a file. */
const EXPECTED = new Map([
  ['UNSUPPORTED_EXTENSION', 'the validator does not know EXT_mesh_gpu_instancing and some newer extensions'],
  ['MESH_PRIMITIVE_GENERATED_TANGENT_SPACE', 'normal maps without tangents: programs make these, as the format says'],
  ['IMAGE_NPOT_DIMENSIONS', 'images have the sizes that they had in the source'],
]);
const SEVERITIES = ['error', 'warning'];

let failed = 0;
for (const path of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), { maxIssues: 0 });
  const kinds = new Map();
  for (const { code, severity, message, pointer } of report.issues.messages) {
    if (severity >= SEVERITIES.length || EXPECTED.has(code)) continue;
    const kind = kinds.get(code) ?? { severity, count: 0, first: `${message} (${pointer})` };
    kinds.set(code, { ...kind, count: kind.count + 1 });
  }
  const { numErrors, numWarnings, truncated } = report.issues;
  console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings, of which ${[...kinds.values()].length} kinds count`);
  for (const [code, { severity, count, first }] of kinds) {
    console.log(`  ${SEVERITIES[severity]} ${code}, ${count} times: ${first}`);
  }
  if (kinds.size > 0 || truncated || numErrors > 0) failed += 1;
}
if (failed > 0) {
  console.error(`error: ${failed} files are not as they should be`);
  process.exit(1);
}
