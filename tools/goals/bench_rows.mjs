// SPDX-License-Identifier: BSD-3-Clause
// What Google Benchmark wrote as JSON.
import {readFileSync} from 'node:fs';

// The spread of a counter that is always 0 is none, which JSON has no word for.
const parse = text => JSON.parse(text.replace(/: -?(nan|inf(inity)?)\b/gi, ': null'));

const nanoseconds = {ns: 1, us: 1e3, ms: 1e6, s: 1e9};

// The runs of a file by the name of their row; rows that failed are left out.
export function rowsOf(file) {
  const rows = new Map();
  for (const run of parse(readFileSync(file, 'utf8')).benchmarks) {
    if (run.run_type !== 'iteration' || run.error_occurred) continue;
    const name = run.name.replace(/\/(iterations:\d+|repeats:\d+|real_time)/g, '');
    rows.set(name, [...(rows.get(name) ?? []), run]);
  }
  return rows;
}

// ns: of the CPU an iteration, a block where the row counts blocks, of the clock with threads.
export function timeOf(run) {
  if (run.per_block !== undefined) return 1e9 * run.per_block;
  return nanoseconds[run.time_unit] * (/real_time/.test(run.name) ? run.real_time : run.cpu_time);
}
