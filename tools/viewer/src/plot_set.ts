// SPDX-License-Identifier: BSD-3-Clause
// Which plots a record asks for: its metadata `oca.plots`. Records of other programs have none; of those the names of
// signals say it.
import { columnsOf, lowest, rates, type Columns } from "./columns";
import { activeCounts, constraintsOf } from "./constraints";
import { upperBound, type Recording, type Topic } from "./recording";

export type Role = "request" | "delta" | "joints" | "distance" | "speed" | "constraints" | "other";
export interface PlotSpec {
  title: string; role: Role; signals: string[]; unit?: string; limit?: number;
  /** The columns are to be differentiated: nobody recorded the speed itself. */
  differentiate?: boolean;
  /** How many constraints are active, a curve a system. */
  counts?: boolean;
}

/** An item of metadata `oca.plots`, see docs/reference/record_format.md. */
interface Hint { id?: string; title?: string; unit?: string; topics?: string[]; limit?: number }
const kRoles: Record<string, Role> = {
  requested: "request", delta: "delta", final: "joints", distance: "distance", speed: "speed", constraints: "constraints",
};

const kDistancesShown = 8;
const kTitles: Record<Role, string> = {
  request: "Requested joints", delta: "Deltas that avoidance adds", joints: "Final joints",
  distance: "Distances", speed: "Joint speeds", constraints: "Active constraints", other: "",
};
const kOrder: Role[] = ["request", "delta", "joints", "distance", "speed", "constraints", "other"];
const kReserved = /^\/(tf|log|metrics)$|^\/scene\//;

/** By the name, of a signal that no hint says more of. */
function roleOf(topic: Topic): Role {
  if (/proximit|distance/i.test(topic.name)) return "distance";
  if (/constraint|active/i.test(topic.name)) return "constraints";
  if (/delta/i.test(topic.name)) return "delta";
  if (/\/(plant|robot|arm)[^/]*\/position$/i.test(topic.name)) return "joints";
  if (/(spline|interpolator|trajectory|request)[^/]*\/position$/i.test(topic.name)) return "request";
  if (/velocity|speed/i.test(topic.name)) return "speed";
  return "other";
}

/** Of the deltas the applied one: what was limited, else relaxed, else any. */
function appliedFirst(a: string, b: string): number {
  const rank = (name: string): number => (/applied/.test(name) ? 0 : /limited/.test(name) ? 1 : /relaxed/.test(name) ? 2 : 3);
  return rank(a) - rank(b);
}

/** Of a record of another program: ours say what they show, by the roles of their systems. */
function guessByNames(recording: Recording): PlotSpec[] {
  const specs: PlotSpec[] = [];
  for (const topic of recording.topics.values()) {
    if (kReserved.test(topic.name) || topic.schemaName.startsWith("foxglove.") || topic.length === 0) continue;
    if (columnsOf(topic).names.length === 0 || /metrics$/.test(topic.name)) continue;
    const role = roleOf(topic);
    specs.push({ title: role === "other" ? topic.name : kTitles[role], role, signals: [topic.name] });
  }
  return specs.sort((a, b) => appliedFirst(a.signals[0]!, b.signals[0]!));
}

function asked(recording: Recording): PlotSpec[] {
  const text = recording.about("plots", "oca.plots") ?? recording.about("plots");
  if (!text) return [];
  try {
    const parsed: unknown = JSON.parse(text);
    const list = Array.isArray(parsed) ? parsed : (parsed as { plots?: unknown[] }).plots ?? [];
    return (list as Hint[]).flatMap(({ id, title, unit, topics, limit }): PlotSpec[] => {
      const signals = (topics ?? []).filter((name) => (recording.topics.get(name)?.length ?? 0) > 0);
      if (signals.length === 0) return [];
      const role = kRoles[id ?? ""] ?? roleOf(recording.topics.get(signals[0]!)!);
      return [{ title: title ?? kTitles[role], role, signals, ...(unit ? { unit } : {}), ...(limit === undefined ? {} : { limit }) }];
    });
  } catch {
    recording.warnings.push("The record's list of plots is no JSON; plots are by name.");
    return [];
  }
}

/** The plots of a record, the report's three first. */
export function plotsOf(recording: Recording): PlotSpec[] {
  const wanted = asked(recording);
  const specs = wanted.length > 0 ? wanted : guessByNames(recording);
  const limit = Number(recording.about("max_distance", "oca.parameters"));
  for (const spec of specs) {
    if (spec.role === "distance" && spec.limit === undefined && limit > 0) spec.limit = limit;
  }
  const joints = specs.find((spec) => spec.role === "joints");
  if (joints && !specs.some((spec) => spec.role === "speed")) {
    specs.push({ title: kTitles.speed, role: "speed", signals: joints.signals, differentiate: true });
  }
  if (!specs.some((spec) => spec.role === "constraints") && constraintsOf(recording, specs).length > 0) {
    specs.push({ title: kTitles.constraints, role: "constraints", signals: [], counts: true });
  }
  return specs.sort((a, b) => kOrder.indexOf(a.role) - kOrder.indexOf(b.role));
}

/** The columns at other times than their own: what they had last. */
function heldAt(times: number[], columns: Columns): (number | null)[][] {
  if (times.length === columns.times.length && times.every((time, row) => time === columns.times[row])) return columns.values;
  const rows = times.map((time) => upperBound(columns.times, time + 1e-9) - 1);
  return columns.values.map((values) => rows.map((row) => values[row] ?? null));
}

/** The path of the system that a signal is of: `left.plant` of `/left/plant/position`. */
export function systemOf(topic: string): string {
  return topic.slice(1, topic.lastIndexOf("/")).replaceAll("/", ".");
}

/** What a plot draws; several signals share the times of the first. */
export function columnsFor(spec: PlotSpec, recording: Recording, specs: PlotSpec[] = [spec]): Columns {
  if (spec.counts) return activeCounts(constraintsOf(recording, specs));
  const all = spec.signals.flatMap((name) => recording.topics.get(name) ?? []).map(columnsOf);
  const first = all[0] ?? { times: [], names: [], values: [], unit: "" };
  const joined: Columns = { ...first, names: [...first.names], values: [...first.values] };
  const named = (i: number): string[] => all[i]!.names.map((name) => `${systemOf(spec.signals[i]!)} ${name}`);
  if (all.length > 1) joined.names = named(0);
  for (let i = 1; i < all.length; ++i) {
    joined.names.push(...named(i));
    joined.values.push(...heldAt(first.times, all[i]!));
  }
  if (spec.unit) joined.unit = spec.unit;
  if (spec.role === "distance") return lowest({ ...joined, unit: joined.unit || "m" }, kDistancesShown);
  return spec.differentiate ? rates(joined) : joined;
}
