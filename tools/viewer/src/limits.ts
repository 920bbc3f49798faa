// SPDX-License-Identifier: BSD-3-Clause
// Which system limited what, and when.
import { columnsFor, systemOf, type PlotSpec } from "./plot_set";
import { constraintsOf } from "./constraints";
import type { Recording } from "./recording";

export interface Span { from: number; to: number }
export interface Limited { system: string; what: string; how: string; spans: Span[]; share: number }

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

export function limitsOf(recording: Recording, specs: PlotSpec[]): Limited[] {
  const found: Limited[] = [];
  for (const { system, what, how, times, holds } of constraintsOf(recording, specs)) {
    const spans = spansOf(times, holds);
    if (spans.length > 0 || !how.startsWith("pushed")) found.push(entry(recording, system, what, how, spans));
  }
  for (const spec of specs) {
    if (spec.role !== "constraints" || spec.counts) continue;
    const columns = columnsFor(spec, recording);
    columns.names.forEach((name, i) => {
      const spans = spansOf(columns.times, (row) => (columns.values[i]![row] ?? 0) > 0);
      found.push(entry(recording, systemOf(spec.signals[0]!), name, "constraint active", spans));
    });
  }
  return found;
}
