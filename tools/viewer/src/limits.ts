// SPDX-License-Identifier: BSD-3-Clause
// Which system limited what, and when: found in the recorded signals.
import { columnsOf, rates } from "./columns";
import { columnsFor, type PlotSpec } from "./plot_set";
import type { Recording } from "./recording";

export interface Span { from: number; to: number }
export interface Limited { system: string; what: string; how: string; spans: Span[]; share: number }

interface Declared { system: string; type?: string; signal: string; bound: number; kind?: string }

/** Times at which `holds` is true, joined to spans. */
export function spansOf(times: number[], holds: (row: number) => boolean): Span[] {
  const spans: Span[] = [];
  let open: Span | undefined;
  for (let i = 0; i < times.length; ++i) {
    const to = times[i + 1] ?? times[i]!;
    if (!holds(i)) open = undefined;
    else if (open) open.to = to;
    else spans.push(open = { from: times[i]!, to });
  }
  return spans;
}

function entry(recording: Recording, system: string, what: string, how: string, spans: Span[]): Limited {
  const total = spans.reduce((sum, span) => sum + span.to - span.from, 0);
  return { system, what, how, spans, share: total / Math.max(1e-9, recording.end - recording.start) };
}

function declared(recording: Recording, specs: PlotSpec[]): Declared[] {
  try {
    const list: unknown = JSON.parse(recording.about("limits", "oca.plots") ?? "null");
    if (Array.isArray(list)) return list as Declared[];
  } catch { /* as if there were none */ }
  const bound = Number(recording.about("max_joint_velocity", "oca.parameters"));
  const delta = specs.find((spec) => spec.role === "delta")?.signals[0];
  if (!(bound > 0) || !delta || recording.about("limit_deltas", "oca.parameters") === "false") return [];
  return [{ system: "DeltaLimiter", type: "DeltaLimiter", signal: delta, bound, kind: "rate" }];
}

export function limitsOf(recording: Recording, specs: PlotSpec[]): Limited[] {
  const found: Limited[] = [];
  for (const one of declared(recording, specs)) {
    const topic = recording.topics.get(one.signal.startsWith("/") ? one.signal : `/${one.signal.replace(".", "/")}`);
    if (!topic) continue;
    const columns = one.kind === "value" ? columnsOf(topic) : rates(columnsOf(topic));
    columns.names.forEach((name, i) => {
      const spans = spansOf(columns.times, (row) => Math.abs(columns.values[i]![row] ?? 0) >= one.bound * 0.999);
      const quantity = one.kind === "value" ? "at its bound" : "change held to";
      found.push(entry(recording, one.system, name, `${quantity} ${one.bound} ${columns.unit}`, spans));
    });
  }
  for (const spec of specs) {
    const columns = columnsFor(spec, recording);
    if (spec.role === "distance" && spec.limit !== undefined) {
      columns.names.forEach((name, i) => {
        const spans = spansOf(columns.times, (row) => (columns.values[i]![row] ?? Infinity) < spec.limit!);
        if (spans.length > 0) found.push(entry(recording, "RepulsiveField", name, `pushed, nearer than ${spec.limit} m`, spans));
      });
    }
    if (spec.role === "constraints") {
      columns.names.forEach((name, i) => {
        const spans = spansOf(columns.times, (row) => (columns.values[i]![row] ?? 0) > 0);
        found.push(entry(recording, spec.signals[0]!.split("/")[1]!, name, "constraint active", spans));
      });
    }
  }
  return found;
}
