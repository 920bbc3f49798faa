// SPDX-License-Identifier: BSD-3-Clause
// What held the motion back, sample by sample: found in the signals that metadata `oca.plots` names.
import { columnsOf, rates, type Columns } from "./columns";
import type { PlotSpec } from "./plot_set";
import type { Recording, Topic } from "./recording";

/** One constraint: `holds(row)` says whether it was active at times[row]. */
export interface Constraint { system: string; what: string; how: string; times: number[]; holds: (row: number) => boolean }

/** An item of `limits` in metadata `oca.plots`, see docs/reference/record_format.md. */
interface Declared {
  system: string; type?: string; signal: string; bound?: number | number[]; kind?: string; member?: string; how?: string;
}

function declared(recording: Recording, specs: PlotSpec[]): Declared[] {
  try {
    const list: unknown = JSON.parse(recording.about("limits", "oca.plots") ?? "null");
    if (Array.isArray(list)) return list as Declared[];
  } catch { /* as if there were none */ }
  const bound = Number(recording.about("max_joint_velocity", "oca.parameters"));
  const delta = specs.find((spec) => spec.role === "delta")?.signals[0];
  const found: Declared[] = [];
  if (bound > 0 && delta && recording.about("limit_deltas", "oca.parameters") !== "false") {
    found.push({ system: "limit of the delta", signal: delta, bound, kind: "rate" });
  }
  for (const spec of specs) {
    if (spec.role !== "distance" || spec.limit === undefined) continue;
    found.push({ system: "repulsion", signal: spec.signals[0]!, bound: spec.limit, kind: "below" });
  }
  return found;
}

const boundOf = (one: Declared, column: number): number =>
  Array.isArray(one.bound) ? one.bound[column] ?? NaN : one.bound ?? NaN;

function ofColumns(one: Declared, columns: Columns): Constraint[] {
  const { system } = one;
  return columns.names.flatMap((what, i): Constraint[] => {
    if (one.member !== undefined && what !== one.member) return [];
    const bound = boundOf(one, i), values = columns.values[i]!;
    if (one.kind === "below") {
      return [{ system, what, how: one.how ?? `pushed, nearer than ${bound} ${columns.unit || "m"}`, times: columns.times,
                holds: (row) => (values[row] ?? Infinity) < bound }];
    }
    if (one.kind === "above") {
      return [{ system, what, how: one.how ?? `above ${bound} ${columns.unit}`.trim(), times: columns.times,
                holds: (row) => (values[row] ?? -Infinity) > bound }];
    }
    const how = one.how ?? `${one.kind === "value" ? "at its bound" : "change held to"} ${bound} ${columns.unit}`;
    return [{ system, what, how, times: columns.times, holds: (row) => Math.abs(values[row] ?? 0) >= bound * 0.999 }];
  });
}

interface Item {
  kind?: string; link?: string; obstacle?: string; joint?: string | number; limit?: string; yields?: string; force?: number[];
}

const kHows: Record<string, string> = { recovery: "moved away", unmovable: "too near, and no joint can change it" };

function nameOf(item: Item, said?: string): [what: string, how: string] {
  if (item.link !== undefined) {
    return [`${item.link} – ${item.obstacle ?? ""}`, kHows[item.kind ?? ""] ?? said ?? "approach held back"];
  }
  const joint = typeof item.joint === "number" ? `joint ${item.joint + 1}` : item.joint ?? "";
  return [`${joint} ${item.limit ?? ""}`.trim(), said ?? "held to a limit of the joint"];
}

/** Whether a listed item does anything: a force of nothing does not. */
const acts = (item: Item): boolean => item.force === undefined || item.force.some((part) => part !== 0);

/** Messages whose member `kind` lists what was active: joints, or links and obstacles. */
function ofLists(one: Declared, topic: Topic): Constraint[] {
  const rows = new Map<string, { what: string; how: string; active: Set<number> }>();
  for (let row = 0; row < topic.length; ++row) {
    const list = (topic.message(row) as Record<string, unknown>)[one.kind ?? ""];
    for (const item of Array.isArray(list) ? (list as Item[]).filter(acts) : []) {
      const [what, how] = nameOf(item, one.how), key = `${how}\n${what}`;
      let found = rows.get(key);
      if (!found) rows.set(key, found = { what, how, active: new Set() });
      found.active.add(row);
    }
  }
  const { system } = one, times = topic.times;
  if (rows.size === 0) return [{ system, what: "all", how: "held nothing back", times, holds: () => false }];
  return [...rows.values()].sort((a, b) => (a.how < b.how ? -1 : 1))
    .map(({ what, how, active }) => ({ system, what, how, times, holds: (row: number) => active.has(row) }));
}

/** What is compared with a bound; any other kind is the name of a list. */
const kCompared = ["rate", "value", "below", "above"];

export function constraintsOf(recording: Recording, specs: PlotSpec[]): Constraint[] {
  return declared(recording, specs).flatMap((one) => {
    const topic = recording.topics.get(one.signal.startsWith("/") ? one.signal : `/${one.signal.replaceAll(".", "/")}`);
    if (!topic || topic.length === 0) return [];
    if (!kCompared.includes(one.kind ?? "rate")) return ofLists(one, topic);
    const columns = columnsOf(topic);
    return ofColumns(one, (one.kind ?? "rate") === "rate" ? rates(columns) : columns);
  });
}

/** How many constraints of each system were active at a time. */
export function activeCounts(constraints: Constraint[]): Columns {
  const times = constraints.reduce<number[]>((most, one) => (one.times.length > most.length ? one.times : most), []);
  const systems = [...new Set(constraints.map((one) => one.system))];
  const values = systems.map(() => new Array<number | null>(times.length).fill(0));
  for (const one of constraints) {
    const counts = values[systems.indexOf(one.system)]!;
    let row = 0;
    times.forEach((time, i) => {
      while (row + 1 < one.times.length && one.times[row + 1]! <= time + 1e-9) ++row;
      if (one.times[row]! <= time + 1e-9 && one.holds(row)) counts[i] = counts[i]! + 1;
    });
  }
  return { times: [...times], names: systems, values, unit: "" };
}
