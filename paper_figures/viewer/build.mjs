// Bundles src/main.js and three.js into one script, $PBS_VIEWER_BUILD/viewer.js (dist/ where that is not set).
import { build } from "esbuild";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const folder = process.env.PBS_VIEWER_BUILD || path.join(here, "dist");

await build({
    absWorkingDir: here,
    entryPoints: ["src/main.js"],
    outfile: path.join(folder, "viewer.js"),
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    charset: "ascii",
    loader: { ".css": "text" },
    legalComments: "eof",
    logLevel: "warning",
});
console.log(`viewer: ${path.join(folder, "viewer.js")}`);
