// SPDX-License-Identifier: BSD-3-Clause
// The tabs beside the plots: how the run went, its parameters, who limited what, its log.
import type { Expectation, RunReport } from "./messages";
import { element } from "./page";
import { short } from "./plots";
import type { Limited } from "./limits";
import type { Recording } from "./recording";

type Seek = (time: number) => void;

/** `u` stands for the unit of the joints. */
const kMetrics: [key: string, name: string, unit: string][] = [
  ["min_distance", "Nearest", "m"], ["contact_time", "In contact", "s"],
  ["final_error", "Off the goal at the end", "u"], ["max_abs_delta", "Largest delta", "u"],
  ["delta_sign_changes_per_second", "Delta reversals", "1/s"],
  ["total_variation_ratio", "Path over the request's", ""], ["max_joint_speed", "Fastest joint", "u/s"],
  ["max_joint_acceleration", "Largest acceleration", "u/s²"],
];

/** Of an arm of which some joints turn and some slide, "rad/s or m/s". */
function unitOfMetric(unit: string, joints: string): string {
  return unit.startsWith("u") ? joints.split(" or ").map((one) => unit.replace("u", one)).join(" or ") : unit;
}

/** All arms as one, as at the end of a run: the nearest approach, the largest of everything else. */
function joined(all: Record<string, unknown>[]): Record<string, unknown> {
  const one: Record<string, unknown> = { ...all[0] };
  for (const other of all.slice(1)) {
    const nearer = (other["min_distance"] as number | null ?? Infinity) < (one["min_distance"] as number | null ?? Infinity);
    for (const [key, value] of Object.entries(other)) {
      const mine = one[key];
      if (key.startsWith("min_distance")) {
        if (nearer) one[key] = value;
      } else if (typeof value === "number") {
        const least = key.startsWith("certified") || key.startsWith("first_contact");
        one[key] = typeof mine !== "number" ? value : least ? Math.min(mine, value) : Math.max(mine, value);
      }
    }
  }
  return one;
}

/** The report of a run: its own topic, or the metrics that each MotionMetrics showed last. */
export function reportOf(recording: Recording): RunReport {
  const own = recording.last("/metrics") as RunReport | undefined;
  if (own?.metrics) return own;
  if (own && "min_distance" in own) return { metrics: own as Record<string, unknown>, ...aboutRun(recording) };
  const all: Record<string, unknown>[] = [];
  for (const topic of recording.topics.values()) {
    if (!topic.name.endsWith("/metrics") || topic.length === 0) continue;
    const last = topic.message(topic.length - 1) as Record<string, unknown>;
    all.push((last["value"] ?? last) as Record<string, unknown>);
  }
  return all.length > 0 ? { metrics: joined(all) } : {};
}

/** What metadata `oca` says of the run: how long it was, what was expected of it. */
function aboutRun(recording: Recording): RunReport {
  const report: RunReport = {}, duration = Number(recording.about("duration"));
  if (duration > 0) report.duration = duration;
  const failure = recording.about("failure");
  if (failure) report.failure = failure;
  try {
    const list: unknown = JSON.parse(recording.about("expectations") ?? "[]");
    if (Array.isArray(list)) report.expectations = list as Expectation[];
  } catch {
    recording.warnings.push("The record's expectations are no JSON.");
  }
  return report;
}

/** Words and a sign, so that nobody needs the colour. */
export function badges(report: RunReport, outcome: string | undefined, warnings: number): HTMLElement[] {
  const made: HTMLElement[] = [];
  const add = (good: boolean, text: string): void => {
    made.push(element("span", `badge ${good ? "good" : "bad"}`, `${good ? "✓" : "✗"} ${text}`));
  };
  const metrics = report.metrics ?? {};
  const nearest = metrics["min_distance"];
  if (report.failure) add(false, "failed");
  if (typeof nearest === "number") add(nearest > 0, nearest > 0 ? `clear by ${short(nearest)} m` : `contact, ${short(-nearest)} m deep`);
  const met = (report.expectations ?? []).filter((one) => one.ok).length, all = report.expectations?.length ?? 0;
  if (all > 0) add(met === all, `${met} of ${all} expectations met`);
  if (made.length === 0 && outcome) made.push(element("span", "badge", outcome));
  if (warnings > 0) made.push(element("span", "badge warn", `⚠ ${warnings === 1 ? "a warning" : `${warnings} warnings`}`));
  return made;
}

/** What was warned of when the diagram was loaded. */
export function warningsOf(recording: Recording): string[] {
  try {
    const list: unknown = JSON.parse(recording.about("warnings", "oca.warnings") ?? "[]");
    return Array.isArray(list) ? list.filter((one): one is string => typeof one === "string") : [];
  } catch {
    return ["The record's warnings are no JSON."];
  }
}

/** What nobody looked at, so that it is not taken for clear. */
function notSeen(recording: Recording): string {
  try {
    const list: unknown = JSON.parse(recording.about("not_seen") ?? "[]");
    return Array.isArray(list) ? list.join("; ") : "";
  } catch {
    return "";
  }
}

/** They stand above all tabs: whoever looks at a plot needs to know them too. */
export function showWarnings(box: HTMLElement, warnings: string[]): void {
  const said = warnings.join("\n");
  if (box.dataset["said"] === said) return;
  box.dataset["said"] = said;
  box.hidden = warnings.length === 0;
  box.replaceChildren(element("summary", "", warnings.length === 1 ? "A warning" : `${warnings.length} warnings`),
                      ...warnings.map((warning) => element("p", "warning", `⚠ ${warning}`)));
}

export function summary(parent: HTMLElement, recording: Recording, report: RunReport, seek: Seek): void {
  const metrics = report.metrics ?? {};
  for (const warning of recording.warnings) parent.append(element("p", "warning", `⚠ ${warning}`));
  const dropped = Number(recording.about("dropped_messages") ?? 0);
  if (dropped > 0) parent.append(element("p", "warning", `⚠ ${dropped} messages did not fit and are not in this record.`));
  if (report.failure) parent.append(element("p", "warning", `✗ ${report.failure}`));
  parent.append(expectationTable(report.expectations ?? []));
  const cards = element("div", "cards"), joints = recording.about("position_unit") ?? "rad";
  for (const [key, name, unit] of kMetrics) {
    const value = metrics[key];
    if (typeof value !== "number") continue;
    const card = element("button", "card");
    card.append(element("b", "", short(value)), element("small", "", unitOfMetric(unit, joints)), element("span", "", name));
    const when = key === "contact_time" ? metrics["first_contact_time"] : metrics[`${key}_time`];
    if (typeof when === "number") {
      const pair = key === "min_distance" ? metrics["min_distance_pair"] : undefined;
      card.append(element("em", "", `${Array.isArray(pair) ? `${pair.join(" – ")}, ` : ""}at ${when.toFixed(2)} s`));
      card.onclick = () => seek(when);
      card.title = "Show this moment";
    } else {
      card.disabled = true;
    }
    cards.append(card);
  }
  parent.append(cards, runTable(recording, report));
}

function expectationTable(expectations: Expectation[]): HTMLElement {
  const table = element("table", "expectations");
  for (const one of expectations) {
    const row = table.insertRow();
    row.append(element("td", one.ok ? "good" : "bad", one.ok ? "✓ met" : "✗ missed"), element("th", "", one.name),
               element("td", "", one.bound), element("td", "number", one.value === null ? "no value" : `got ${short(one.value)}`));
  }
  return table;
}

function runTable(recording: Recording, report: RunReport): HTMLElement {
  const table = element("table", "facts");
  const add = (name: string, value: unknown): void => {
    if (value === undefined || value === null || value === "") return;
    const row = table.insertRow();
    row.append(element("th", "", name), element("td", "", String(value)));
  };
  add("Not seen", notSeen(recording));
  add("Diagram", recording.about("diagram"));
  add("Duration", report.duration !== undefined ? `${report.duration} s` : `${recording.end.toFixed(2)} s`);
  add("Took", report.wall_seconds !== undefined ? `${short(report.wall_seconds)} s` : undefined);
  add("Steps", report.steps);
  add("Seed", recording.about("seed") ?? report.seed);
  add("OCA", recording.about("version"));
  add("Overrides", [...(recording.metadata.get("oca.overrides") ?? [])].map(([key, value]) => `${key} = ${value}`).join(", "));
  return table;
}

/** Parameters as a table; what was overridden is marked. */
export function parameters(parent: HTMLElement, recording: Recording): void {
  const values = recording.metadata.get("oca.parameters");
  if (!values || values.size === 0) parent.append(element("p", "empty", "No parameters were recorded."));
  const overrides = new Set([...(recording.metadata.get("oca.overrides")?.keys() ?? [])].map((key) => key.replace(/^parameters\./, "")));
  const table = element("table", "facts");
  for (const [name, value] of values ?? []) {
    const row = table.insertRow();
    row.append(element("th", "", name), element("td", "number", value),
               element("td", "", overrides.has(name) ? "overridden" : ""));
  }
  parent.append(table);
  for (const [name, bytes] of recording.attachments) {
    if (!/\.(ya?ml|urdf|srdf)$/.test(name)) continue;
    const details = element("details");
    details.append(element("summary", "", name), element("pre", "", new TextDecoder().decode(bytes)));
    parent.append(details);
  }
}

/** A strip of time a row, dark where the limit held. */
export function limits(parent: HTMLElement, recording: Recording, found: Limited[], seek: Seek): void {
  if (found.length === 0) parent.append(element("p", "empty", "Nothing that was recorded shows a limit."));
  const length = Math.max(1e-9, recording.end - recording.start);
  let system = "", how = "";
  for (const one of found) {
    if (one.system !== system || one.how !== how) {
      [system, how] = [one.system, one.how];
      const heading = element("h3", "", system);
      heading.append(element("small", "", how));
      parent.append(heading);
    }
    const row = element("div", "strip");
    const bar = element("div", "bar");
    for (const span of one.spans) {
      const mark = element("i");
      mark.style.left = `${(100 * (span.from - recording.start)) / length}%`;
      mark.style.width = `max(1px, ${(100 * (span.to - span.from)) / length}%)`;
      bar.append(mark);
    }
    bar.onclick = (event) => seek(recording.start + (event.offsetX / bar.clientWidth) * length);
    row.append(element("span", "", one.what), bar, element("b", "", one.spans.length === 0 ? "never" : `${(100 * one.share).toFixed(0)} %`));
    parent.append(row);
  }
}

interface LogMessage { level?: number; message?: string; name?: string }
const kLevels = ["", "debug", "info", "warning", "error", "fatal"];
const kLogLines = 2000;

export function logLines(parent: HTMLElement, recording: Recording, seek: Seek): void {
  const topic = recording.topics.get("/log");
  if (!topic || topic.length === 0) parent.append(element("p", "empty", "Nothing was logged."));
  const list = element("ol", "log");
  for (let i = Math.max(0, (topic?.length ?? 0) - kLogLines); topic && i < topic.length; ++i) {
    const line = topic.message(i) as LogMessage, time = topic.times[i]!;
    const item = element("li", `level${line.level ?? 2}`, `${time.toFixed(2)} s  ${kLevels[line.level ?? 2] ?? ""}  ${line.message ?? ""}`);
    item.onclick = () => seek(time);
    list.append(item);
  }
  parent.append(list);
}
