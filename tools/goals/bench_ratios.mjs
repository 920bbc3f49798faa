// SPDX-License-Identifier: BSD-3-Clause
// Usage: node bench_ratios.mjs FOLDER: the rows of before.now.*.json there to those of before.then.*.json. Prints
// each ratio of least times on standard error, and the worst.
import {readdirSync} from 'node:fs';
import {join} from 'node:path';

import {rowsOf, timeOf} from './bench_rows.mjs';

const folder = process.argv[2];

function leastTimes(kind) {
  const least = new Map();
  for (const name of readdirSync(folder)) {
    if (!name.startsWith(`before.${kind}.`)) continue;
    for (const [row, runs] of rowsOf(join(folder, name))) {
      least.set(row, Math.min(least.get(row) ?? Infinity, ...runs.map(timeOf)));
    }
  }
  return least;
}

const before = leastTimes('then');
const ratios = [...leastTimes('now')].filter(([row]) => before.has(row) && !row.endsWith('/floor'))
  .map(([row, time]) => [row, time / before.get(row)]);
for (const [row, ratio] of ratios) console.error(`${row} ${ratio.toFixed(3)}`);
if (ratios.length > 0) console.log(Math.max(...ratios.map(([, ratio]) => ratio)).toFixed(3));
else process.exitCode = 1;
