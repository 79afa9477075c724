// Bundles src/main.js and three.js, with the text of its licence, into one script: $PBS_VIEWER_BUILD/viewer.js (dist/
// if that is not set).
import { build } from "esbuild";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const folder = process.env.PBS_VIEWER_BUILD || path.join(here, "dist");

const licence = fs.readFileSync(path.join(here, "node_modules/three/LICENSE"), "utf8");

await build({
    absWorkingDir: here, entryPoints: ["src/main.js"], outfile: path.join(folder, "viewer.js"), bundle: true,
    minify: true, format: "iife", target: "es2022", charset: "ascii", loader: { ".css": "text", ".glsl": "text" },
    banner: { js: `/*! three.js\n${licence}*/` }, legalComments: "eof", logLevel: "warning",
});
console.log(`viewer: ${path.join(folder, "viewer.js")}`);
