// SPDX-License-Identifier: MIT
// run.mjs PROGRAM.wasm [NAME=FILE.brume]...: loads the files into the memory
// of the program, runs it, and prints what it writes.
import { readFileSync } from 'node:fs';

const PAGE = 65536;
const [, , program, ...assets] = process.argv;
if (program === undefined || program === '--help') {
  console.log('usage: node run.mjs PROGRAM.wasm [NAME=FILE.brume]...');
  process.exit(program === undefined ? 2 : 0);
}

const imports = {
  env: {
    write(text, size) {
      process.stdout.write(Buffer.from(memory.buffer, text, size).toString());
    },
  },
};

// Copies bytes behind all that is there, on a multiple of 64.
let free = 0;
function place(bytes) {
  const at = (free + 63) & ~63;
  free = at + bytes.length;
  const missing = free - memory.buffer.byteLength;
  if (missing > 0) memory.grow(Math.ceil(missing / PAGE));
  new Uint8Array(memory.buffer).set(bytes, at);
  return at;
}

function fail(text) {
  console.error(text);
  process.exit(2);
}

const module = new WebAssembly.Module(readFileSync(program));
const { exports } = new WebAssembly.Instance(module, imports);
const { memory } = exports;
free = exports.first_free();
for (const argument of assets) {
  const cut = argument.indexOf('=');
  if (cut < 1) fail(`${argument}: not NAME=FILE`);
  let bytes;
  try {
    bytes = readFileSync(argument.slice(cut + 1));
  } catch (error) {
    fail(`${argument}: ${error.message}`);
  }
  const name = place(Buffer.from(argument.slice(0, cut) + '\0'));
  if (!exports.add_asset(name, place(bytes), bytes.length))
    fail(`${argument}: too many assets`);
}
process.exitCode = exports.run();
