// SPDX-License-Identifier: BSD-3-Clause
// What tools/benchmark_scenes.sh does, whose head says how it is used.
import { execFile } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { parseArgs } from "node:util";

const PLANS_A_SECOND = 50;
const ARRIVED = 0.01; // rad, and rad/s
const TIMEOUT = 600; // s; of one process

function usage(text) {
  console.error(`benchmark_scenes.sh: ${text}; --help tells more`);
  process.exit(64);
}

function readArguments() {
  const options = {
    srdf: { type: "string" }, family: { type: "string", multiple: true, default: [] },
    samples: { type: "string" }, seed: { type: "string" }, jobs: { type: "string", default: "1" },
    intruder: { type: "string" },
    set: { type: "string", multiple: true, default: [] }, duration: { type: "string", default: "20" },
    "no-plan": { type: "boolean", default: false }, reference: { type: "boolean", default: false },
    output: { type: "string", short: "o", default: "build/scenes" },
  };
  let parsed;
  try {
    parsed = parseArgs({ options, allowPositionals: true });
  } catch (error) {
    usage(error.message);
  }
  const { values, positionals } = parsed;
  if (positionals.length !== 2) usage(`got ${positionals.length} words; expected FOLDER and ROBOT`);
  for (const key of ["samples", "seed", "jobs", "intruder"]) {
    if (values[key] === undefined) continue;
    if (!/^\d{1,9}$/.test(values[key]) || (key !== "seed" && key !== "intruder" && Number(values[key]) < 1)) {
      usage(`--${key}: got '${values[key]}'; expected a whole number`);
    }
    values[key] = Number(values[key]);
  }
  if (!(Number(values.duration) > 0)) usage(`--duration: got '${values.duration}'; expected seconds`);
  if (values.intruder !== undefined && values["no-plan"]) usage("--intruder: got it with --no-plan; expected foresight to compare with");
  const [folder, robot] = positionals;
  const beside = robot.replace(/(\.urdf)?\.[^.]*$/, ".srdf");
  const srdf = values.srdf ?? (robot.startsWith("package://") || existsSync(beside) ? beside : "");
  return { ...values, duration: Number(values.duration), folder, robot, srdf };
}

/** The problems of a folder, by family. */
function findProblems(folder, wanted) {
  const families = new Map();
  const look = (place, family) => {
    const problems = [];
    for (const name of readdirSync(place).sort()) {
      const found = /^scene(.*)\.(yaml|scene)$/.exec(name);
      const request = found && join(place, `request${found[1]}.yaml`);
      if (found && existsSync(request)) problems.push({ family, number: found[1] || "0", scene: join(place, name), request });
    }
    if (problems.length > 0 && (wanted.length === 0 || wanted.includes(family))) families.set(family, problems);
  };
  look(folder, basename(resolve(folder)));
  for (const entry of readdirSync(folder, { withFileTypes: true }).sort((a, b) => (a.name < b.name ? -1 : 1))) {
    if (entry.isDirectory()) look(join(folder, entry.name), entry.name);
  }
  return families;
}

/** A generator of numbers in [0, 1) that is the same everywhere: xorshift. */
function randomOf(seed) {
  let state = (seed * 2654435761 + 88172645) >>> 0 || 1;
  return () => {
    state ^= state << 13; state ^= state >>> 17; state ^= state << 5; state >>>= 0;
    return state / 4294967296;
  };
}

function pick(problems, samples, seed) {
  if (samples === undefined || samples >= problems.length) return problems;
  if (seed === undefined) return Array.from({ length: samples }, (_, i) => problems[Math.floor((i * problems.length) / samples)]);
  const random = randomOf(seed), left = [...problems], picked = [];
  while (picked.length < samples) picked.push(...left.splice(Math.floor(random() * left.length), 1));
  return picked.sort((a, b) => problems.indexOf(a) - problems.indexOf(b));
}

function simulate(words) {
  return new Promise((done) => {
    const options = { timeout: 1000 * TIMEOUT, maxBuffer: 1 << 28 };
    execFile(process.env.SIMULATOR, words, options, (error, out, err) => {
      done({ status: error ? error.code ?? -1 : 0, out, err: error?.killed ? `more than ${TIMEOUT} s` : err });
    });
  });
}

/** Of a problem's intruder: FNV-1a of its name, mixed with the seed that was given. */
function seedOf(seed, name) {
  let hash = (2166136261 ^ seed) >>> 0;
  for (const letter of name) hash = Math.imul(hash ^ letter.charCodeAt(0), 16777619) >>> 0;
  return String(hash >>> 1);
}

const lastLine = (text) => text.trim().split("\n").at(-1) ?? "";

/** One problem through import, run and plan. */
async function solve(problem, settings, out) {
  const diagram = join(out, problem.family, `scene${problem.number}.yaml`);
  for (const name of readdirSync(join(out, problem.family))) {
    if (name.startsWith(`scene${problem.number}.`) || name.startsWith(`scene${problem.number}_`)) rmSync(join(out, problem.family, name));
  }
  const robot = ["--robot", settings.robot, ...(settings.srdf ? ["--srdf", settings.srdf] : [])];
  const flies = settings.intruder !== undefined;
  const imported = await simulate(["import", problem.scene, problem.request, ...robot, ...(flies ? ["--intruder"] : []), "-o", diagram]);
  if (imported.status !== 0) return { error: lastLine(imported.err) };
  const set = settings.set.flatMap((one) => ["-s", one]);
  if (flies) set.push("--seed", seedOf(settings.intruder, `${problem.family}/${problem.number}`));
  const result = {};
  const ran = await simulate(["run", diagram, ...set, "-t", settings.duration, "--json", "--profile", "--no-progress"]);
  if (ran.status === 0 || ran.status === 3) {
    const { metrics, profile, wall_seconds } = JSON.parse(ran.out);
    result.run = { metrics, wall_seconds, times: profile?.find((one) => one.system === "band")?.times ?? [] };
  } else {
    result.error = lastLine(ran.err);
  }
  if (!settings.plan) return result;
  const reference = settings.reference ? ["--reference", "1"] : [];
  const planned = await simulate(["plan", diagram, ...set, "-t", settings.duration, ...reference]);
  if (planned.status === 0 || planned.status === 3) result.plan = JSON.parse(planned.out);
  else result.plan_error = lastLine(planned.err);
  return result;
}

function wilson(hits, count) {
  if (count === 0) return [0, 1];
  const z = 1.959963984540054, p = hits / count, n = count;
  const middle = (p + (z * z) / (2 * n)) / (1 + (z * z) / n);
  const half = (z / (1 + (z * z) / n)) * Math.sqrt((p * (1 - p)) / n + (z * z) / (4 * n * n));
  return [Math.max(0, middle - half), Math.min(1, middle + half)];
}

function share(hits, count) {
  const [low, high] = wilson(hits, count).map((one) => (100 * one).toFixed(1));
  return `${hits}/${count} [${low}, ${high}] %`;
}

/** The nearest rank; the numbers need not be sorted. */
function quantile(numbers, q) {
  if (numbers.length === 0) return null;
  const sorted = [...numbers].sort((a, b) => a - b);
  return sorted[Math.max(0, Math.ceil(q * sorted.length) - 1)];
}

const show = (number, digits) => (number === null || number === undefined ? "-" : number.toFixed(digits));

/** Of the slowest `count` calls of a run, [time, number] ascending. */
function slowest(times, count) {
  const kept = [];
  for (const [time, calls] of [...times].reverse()) {
    const taken = Math.min(calls, count);
    if (taken > 0) kept.push([time, taken]);
    count -= taken;
  }
  return kept;
}

function quantileOfClasses(classes, q) {
  const sorted = [...classes].sort((a, b) => a[0] - b[0]);
  const all = sorted.reduce((sum, [, calls]) => sum + calls, 0);
  let so_far = 0;
  for (const [time, calls] of sorted) {
    so_far += calls;
    if (so_far >= q * all) return 1000 * time;
  }
  return null;
}

function ofRuns(name, results, settings) {
  const runs = results.filter((one) => one.run).map((one) => ({ ...one.run.metrics, times: one.run.times, reference: one.plan?.reference_length }));
  const arrived = runs.filter((one) => one.final_error !== null && one.final_error <= ARRIVED && one.final_speed < ARRIVED);
  const classes = runs.flatMap((one) => slowest(one.times, Math.round(PLANS_A_SECOND * settings.duration)));
  const ratios = arrived.filter((one) => one.reference > 0).map((one) => one.path_length / one.reference);
  return [name, share(runs.filter((one) => one.certified_min_distance > 0 || (one.certified_min_distance === null && one.min_distance === null)).length, results.length),
    share(arrived.length, results.length),
    `${show(quantile(arrived.map((one) => one.time_to_goal), 0.5), 2)} ${show(quantile(arrived.map((one) => one.time_to_goal), 0.95), 2)}`,
    `${show(quantile(arrived.map((one) => one.path_length), 0.5), 2)} ${show(quantile(ratios, 0.5), 2)}`,
    [0.5, 0.95, 0.99, 1].map((q) => show(quantileOfClasses(classes, q), 3)).join(" "),
    `${runs.filter((one) => one.stuck_time > 0).length}`, `${results.length - runs.length}`];
}

/** With an intruder: of what foresight clears, what the loop does. */
function ofClearable(name, results) {
  const clearable = results.filter((one) => one.plan?.clear);
  return [name, share(clearable.filter((one) => one.run?.metrics.certified_min_distance > 0).length, clearable.length)];
}

function ofPlans(name, results) {
  const plans = results.filter((one) => one.plan).map((one) => one.plan);
  const good = plans.filter((one) => one.clear && one.arrived);
  const seconds = plans.map((one) => 1000 * one.search_seconds);
  return [name, share(plans.filter((one) => one.clear).length, results.length), share(good.length, results.length),
    `${show(quantile(good.map((one) => one.time_to_goal), 0.5), 2)} ${show(quantile(good.map((one) => one.time_to_goal), 0.95), 2)}`,
    `${show(quantile(good.map((one) => one.path_length), 0.5), 2)} ${show(quantile(good.filter((one) => one.reference_length > 0).map((one) => one.path_length / one.reference_length), 0.5), 2)}`,
    [0.5, 0.95, 0.99, 1].map((q) => show(quantile(seconds, q), 0)).join(" "), "-", `${results.length - plans.length}`];
}

function table(head, rows) {
  const widths = head.map((_, i) => Math.max(...[head, ...rows].map((row) => row[i].length)));
  for (const row of [head, ...rows]) console.log(row.map((cell, i) => cell.padEnd(widths[i])).join("  ").trimEnd());
}

async function main() {
  const given = readArguments();
  let families;
  try {
    families = findProblems(given.folder, given.family);
  } catch (error) {
    usage(`${given.folder}: ${error.message}`);
  }
  if (families.size === 0) {
    console.error(`${given.folder}: problems; got none; expected sceneNNNN.yaml with requestNNNN.yaml${given.family.length ? ` of ${given.family}` : ""}`);
    process.exit(2);
  }
  const settings = { folder: resolve(given.folder), robot: given.robot.startsWith("package://") ? given.robot : resolve(given.robot),
    srdf: given.srdf && !given.srdf.startsWith("package://") ? resolve(given.srdf) : given.srdf, set: given.set, duration: given.duration,
    plan: !given["no-plan"], reference: given.reference, intruder: given.intruder };
  const out = given.output, stated = join(out, "settings.json"), text = JSON.stringify(settings);
  mkdirSync(out, { recursive: true });
  if (existsSync(stated) && readFileSync(stated, "utf8") !== text) {
    usage(`${out}: has results of other settings (settings.json); expected a folder of their own (-o)`);
  }
  writeFileSync(stated, text);

  const problems = [...families.values()].flatMap((all) => pick(all, given.samples, given.seed));
  const fileOf = (problem) => join(out, problem.family, `${problem.number}.json`);
  const left = problems.filter((problem) => !existsSync(fileOf(problem)));
  let done = problems.length - left.length;
  const work = async () => {
    for (let problem = left.shift(); problem; problem = left.shift()) {
      mkdirSync(join(out, problem.family), { recursive: true });
      const result = await solve(problem, settings, out);
      writeFileSync(`${fileOf(problem)}.part`, JSON.stringify(result));
      renameSync(`${fileOf(problem)}.part`, fileOf(problem));
      console.error(`${++done}/${problems.length} ${problem.family} ${problem.number}${result.error ? `: ${result.error}` : ""}`);
    }
  };
  await Promise.all(Array.from({ length: given.jobs }, work));

  const results = problems.map((problem) => ({ family: problem.family, ...JSON.parse(readFileSync(fileOf(problem), "utf8")) }));
  const names = [...families.keys()];
  const groups = [...names.map((name) => [name, results.filter((one) => one.family === name)]), ["all", results]];
  const head = (what) => [what, "clear [95 %]", "arrived [95 %]", "to goal s", "path ratio", "plan ms 50 95 99 max", "stuck", "failed"];
  table(head("closed loop"), groups.map(([name, some]) => ofRuns(name, some, settings)));
  if (settings.plan) {
    console.log();
    table(head("simulator plan"), groups.map(([name, some]) => ofPlans(name, some)));
    if (settings.intruder !== undefined) {
      console.log();
      table(["of what plan clears", "clear [95 %]"], groups.map(([name, some]) => ofClearable(name, some)));
    }
  }
}

await main();
