// SPDX-License-Identifier: BSD-3-Clause
// Builds dist/viewer.html: the whole page in one file that loads nothing else.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, "dist/viewer.html"));
const result = await build({
  entryPoints: [join(here, "src/main.ts")],
  bundle: true, minify: true, write: false, format: "esm", target: "es2022",
  outdir: "out", legalComments: "inline", logLevel: "warning",
  define: { global: "globalThis" },
});
const text = (ending) => result.outputFiles.find((file) => file.path.endsWith(ending)).text;
// A script element ends at the first "</script", wherever it stands.
const script = text(".js").replaceAll("</script", "<\\/script");
const template = await readFile(join(here, "src/index.html"), "utf8");
const page = template.replace("/*oca:style*/", () => text(".css"))
                     .replace("/*oca:script*/", () => script);
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page);
console.log(`${out}: ${(page.length / 1024).toFixed(0)} KiB`);
