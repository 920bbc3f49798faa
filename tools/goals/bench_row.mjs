// SPDX-License-Identifier: BSD-3-Clause
// Usage: node bench_row.mjs RESULTS.json ROW | ROW:COUNTER... | ROW / ROW | ROW - ROW
import {rowsOf, timeOf} from './bench_rows.mjs';

const [file, ...words] = process.argv.slice(2);
const rows = rowsOf(file);

function valueOf(word) {
  const counted = /^(.*):([A-Za-z]\w*)$/.exec(word);  // threads:2 is part of a row's name
  const [name, counter] = counted === null ? [word, null] : counted.slice(1);
  const runs = rows.get(name);
  if (runs === undefined) throw new Error(`no row ${name}`);
  const values = runs.map((run) => counter === null ? timeOf(run) : run[counter]);
  if (values.some((value) => !Number.isFinite(value))) throw new Error(`no ${counter} of ${name}`);
  return Math.min(...values);
}

try {
  const [first, operation, second] = words;
  if (operation === '/') console.log(valueOf(first) / valueOf(second));
  else if (operation === '-') console.log(valueOf(first) - valueOf(second));
  else console.log(words.map(valueOf).reduce((sum, value) => sum + value, 0));
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
}
