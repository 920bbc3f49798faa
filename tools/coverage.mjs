// SPDX-License-Identifier: BSD-3-Clause
// Usage: node coverage.mjs BUILD: a table of what gcov counted there. A line counts once, however many
// programs were compiled from it, and as run if it was in any.
import {execFileSync} from 'node:child_process';
import {readdirSync} from 'node:fs';
import {dirname, join, relative, resolve} from 'node:path';

const build = resolve(process.argv[2]);
const counts = readdirSync(build, {recursive: true}).filter((name) => name.endsWith('.gcda'));
const files = new Map();  // file -> line -> whether it ran
for (const name of counts) {
  const options = ['--json-format', '--stdout', '--relative-only', '--source-prefix', process.cwd()];
  const text = execFileSync('gcov', [...options, join(build, name)],
                            {maxBuffer: 1 << 30, stdio: ['ignore', 'pipe', 'ignore']});
  for (const line of text.toString().split('\n').filter(Boolean)) {
    const {files: read} = JSON.parse(line);
    for (const {file, lines} of read) {
      const path = relative(process.cwd(), file);
      if (!/^(framework|models|systems|diagrams|tools)\//.test(path)) continue;
      const ran = files.get(path) ?? new Map();
      for (const {line_number: number, count} of lines) ran.set(number, ran.get(number) || count > 0);
      files.set(path, ran);
    }
  }
}

const folders = new Map();  // folder -> [lines, those that ran]
for (const [path, ran] of files) {
  for (const folder of [dirname(path), 'all']) {
    const sum = folders.get(folder) ?? [0, 0];
    folders.set(folder, [sum[0] + ran.size, sum[1] + [...ran.values()].filter(Boolean).length]);
  }
}
if (folders.size === 0) throw new Error(`${build}: no counts; expected a build with --coverage whose tests ran`);
console.log('| folder                  |  lines |    run |      % |');
console.log('| ---                     |    --: |    --: |    --: |');
const rows = [...folders].sort().filter(([folder]) => folder !== 'all');
for (const [folder, [lines, ran]] of [...rows, ['all', folders.get('all')]]) {
  const cells = [String(lines).padStart(6), String(ran).padStart(6), (100 * ran / lines).toFixed(1).padStart(6)];
  console.log(`| ${folder.padEnd(23)} | ${cells.join(' | ')} |`);
}
