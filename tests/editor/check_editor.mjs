// SPDX-License-Identifier: BSD-3-Clause
// What an editor shows of diagram files: nothing on those that are right, a mark on each mistake.
// Usage: node check_editor.mjs SOURCE SCHEMA; SCHEMA is for files that name none.
import {existsSync, readdirSync, readFileSync, statSync} from 'node:fs';
import {dirname, join, resolve} from 'node:path';

import {LanguageServer} from './language_server.mjs';

const [source, schema] = process.argv.slice(2).map((path) => resolve(path));
let failures = 0;

function fail(text) {
  console.error(`FAILED ${text}`);
  ++failures;
}

function yamlFiles(folder) {
  return readdirSync(folder).sort().flatMap((name) => {
    const path = join(folder, name);
    if (statSync(path).isDirectory()) return name === 'node_modules' ? [] : yamlFiles(path);
    return name.endsWith('.yaml') ? [path] : [];
  });
}

/// Rather than what a xacro loads, say.
function isDiagram(file) {
  return /^(systems|include|models|sampling):/m.test(readFileSync(file, 'utf8'));
}

async function expectNoMarks(server, file) {
  for (const {line, message} of await server.marks(file)) fail(`${file}:${line}: ${message}`);
}

const editor = new LanguageServer();
await editor.start();
const shipped = yamlFiles(join(source, 'diagrams'));
for (const file of shipped) {
  // The first line leads to the schema, in the tree and where it is installed.
  const named = /^# yaml-language-server: \$schema=(\S+)\n/.exec(readFileSync(file, 'utf8'));
  if (named === null) fail(`${file}: its first line names no schema`);
  else if (!existsSync(join(dirname(file), named[1]))) fail(`${file}: no ${named[1]}; not built?`);
  else await expectNoMarks(editor, file);
}

const nameless = new LanguageServer({schemas: {[schema]: '*.yaml'}});
await nameless.start();
// Not those with types of somebody else: a program that adds types prints a schema of its own.
const own = yamlFiles(join(source, 'tests')).filter(
    (path) => !path.includes('/tests/consumer/') && isDiagram(path));
for (const file of own) await expectNoMarks(nameless, file);
nameless.stop();

// [what is wrong, file, text there, what is written instead, what the mark says]
const mistakes = [
  ['a wrong section', 'static_test', 'expect:', 'expects:', /expects is not allowed/],
  ['a wrong key of a section', 'static_test', 'duration:', 'duraton:', /duraton is not allowed/],
  ['a wrong key of a system', 'static_test', 'kind: cubic', 'knd: cubic', /knd is not allowed/],
  ['a key that another system has', 'static_test', 'kind: cubic', 'gain: 1', /gain is not allowed/],
  ['a wrong key of a system whose type an included file names', 'static_test', 'ignore:', 'ignor:',
   /ignor is not allowed/],
  ['a wrong key in a list', 'static_test', 'shape: {type: box, size', 'shape: {type: box, sice',
   /sice is not allowed/],
  ['a wrong key of a model', 'static_test', 'srdf:', 'sdrf:', /sdrf is not allowed/],
  ['an unknown type', 'static_test', 'type: ObstacleSource', 'type: ObstacleSauce',
   /not accepted.*"ObstacleSource"/],
  ['a value that is none of its words', 'static_test', 'kind: cubic', 'kind: cubik',
   /not accepted.*"cubic"/],
  ['text for a number', 'static_test', 'duration: 14.5', 'duration: long', /\$\\\{/],
  ['a list for a number', 'static_test', 'duration: 14.5', 'duration: [14.5]', /type.*number/],
  ['a number for a list', 'static_test', 'others: [frame]', 'others: 3', /type.*array/],
  ['a number for text', 'static_test', 'name: static_test', 'name: 7', /type.*string/],
  ['a number out of range', 'static_test', 'duration: 14.5', 'duration: -1', /below the minimum of 0/],
  ['a number out of range of a system', 'lag_step', 'time_constant: 0.05', 'time_constant: 0',
   /exclusive minimum of 0/],
  ['a number out of range, of a system whose type an included file names', 'static_test',
   'others: [frame]', 'max_distance: -1', /minimum of 0/],
  ['a number out of range in a list', 'static_test', 'size: [0.2, 0.2, 0.2]', 'size: [0.2, 0, 0.2]',
   /exclusive minimum of 0/],
  ['a list that is too short', 'static_test', 'size: [0.2, 0.2, 0.2]', 'size: [0.2, 0.2]', /few items/],
  ['a connection without an arrow', 'lag_step', 'source.value -> lag.in', 'source.value lag.in', /pattern/],
  ['no type where nothing is included', 'lag_step', 'type: FirstOrderLag, ', '', /Missing property "type"/],
  ['a missing parameter where nothing is included', 'lag_step', ', time_constant: 0.05', '',
   /Missing property "time_constant"/],
  ['a missing key in a list', 'static_test', '{id: box, ', '{', /Missing property "id"/],
];
for (const [what, name, text, instead, says] of mistakes) {
  const file = shipped.find((path) => path.endsWith(`/${name}.yaml`));
  const right = readFileSync(file, 'utf8');
  const at = right.indexOf(text);
  if (at < 0) {
    fail(`${what}: no '${text}' in ${file}`);
    continue;
  }
  const line = right.slice(0, at).split('\n').length;
  const marks = await editor.marks(file, right.slice(0, at) + instead + right.slice(at + text.length));
  const found = marks.some((mark) => mark.line === line && says.test(mark.message));
  if (!found) fail(`${what}: ${name}.yaml:${line}: got ${JSON.stringify(marks)}; expected ${says}`);
}
// What it offers and says where a person writes.
const fresh = join(source, 'diagrams/fresh.yaml');  // need not exist
const start = '# yaml-language-server: $schema=diagram.schema.json\nname: fresh\nsystems:\n  field:\n    type: ';
const types = await editor.offers(fresh, start, 5, 11);
if (!types.includes('RepulsiveField') || types.length < 25) fail(`types: offered ${types}`);
const keys = await editor.offers(fresh, `${start}RepulsiveField\n    `, 6, 5);
if (keys.join() !== 'force_gain,max_distance,min_distance') fail(`keys of a RepulsiveField: offered ${keys}`);
const said = await editor.says(fresh, `${start}RepulsiveField\n    force_gain: 1`, 6, 7);
if (!/eq\. \(3\.1\).*N m\^3/.test(said)) fail(`force_gain: said ${said}`);
editor.stop();

console.log(`${shipped.length + own.length} files, ${mistakes.length} mistakes, ${failures} failures`);
process.exitCode = failures === 0 ? 0 : 1;
