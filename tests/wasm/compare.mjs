// compare.mjs MODULE LIST: runs the module and compares what is registered in it with the list in a file.
import { readFileSync } from "node:fs";

const [module, file] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(module), {});
const { initialise, registered, text, linked, memory } = instance.exports;

initialise();
const length = registered();
const found = new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length));
const wanted = readFileSync(file, "utf8");
// Models and scenes are indented, kinds are not.
const models = found.split("\n").filter((line) => line.startsWith(" ")).length;

if (found !== wanted) {
    console.error(`what is registered on WebAssembly is not the list of ${file}:\n${found}`);
    process.exit(1);
}
if (models !== linked()) {
    console.error(`${models} models and scenes are registered, the crates link ${linked()}`);
    process.exit(1);
}
console.log(`${models} models and scenes on WebAssembly, as on this machine`);
