// SPDX-License-Identifier: BSD-3-Clause
// From the messages of a signal to columns of numbers.
import type { Topic } from "./recording";

/** A signal as columns of equal length; what a message lacks is null. */
export interface Columns { times: number[]; names: string[]; values: (number | null)[][]; unit: string }

interface Near { link: string; obstacle: string; distance: number }
const isNear = (item: unknown): item is Near =>
  typeof item === "object" && item !== null && "distance" in item && "link" in item;

/** The numbers in one message, by name: {a1: 0.1}, {values: [...]}, [...], lists of proximities. */
export function numbersIn(message: unknown): [string, number][] {
  if (typeof message === "number") return [["", message]];
  if (typeof message === "boolean") return [["", Number(message)]];
  if (Array.isArray(message)) {
    return message.flatMap((item, i): [string, number][] => {
      if (isNear(item)) return [[`${item.link} – ${item.obstacle}`, item.distance]];
      if (typeof item === "number" || typeof item === "boolean") return [[`[${i}]`, Number(item)]];
      return [];
    });
  }
  if (typeof message !== "object" || message === null) return [];
  const entries = Object.entries(message);
  if (entries.length === 1 && typeof entries[0]![1] === "object") return numbersIn(entries[0]![1]);
  return entries.flatMap(([key, value]): [string, number][] =>
    typeof value === "number" || typeof value === "boolean" ? [[key, Number(value)]] : []);
}

/** The messages from index `from` on, added to `columns`. */
export function extend(columns: Columns, topic: Topic, from: number): void {
  for (let i = from; i < topic.length; ++i) {
    const row = columns.times.length;
    columns.times.push(topic.times[i]!);
    for (const [name, value] of numbersIn(topic.message(i))) {
      let column = columns.names.indexOf(name);
      if (column < 0) {
        column = columns.names.push(name) - 1;
        columns.values.push(new Array<number | null>(row).fill(null));
      }
      columns.values[column]![row] = Number.isFinite(value) ? value : null;
    }
    for (const values of columns.values) if (values.length === row) values.push(null);
  }
}

/** What was read of a topic, so that nobody reads it again. */
const known = new WeakMap<Topic, { columns: Columns; forgotten: number }>();

/** The columns of a topic; they grow with it, so nobody may change them. */
export function columnsOf(topic: Topic): Columns {
  let found = known.get(topic);
  if (!found || found.forgotten !== topic.forgotten) {
    const columns = { times: [], names: [], values: [], unit: unitOf(topic.schema) };
    known.set(topic, found = { columns, forgotten: topic.forgotten });
  }
  extend(found.columns, topic, found.columns.times.length);
  return found.columns;
}

/** The first `x-unit` anywhere in a JSON Schema. */
export function unitOf(schema: unknown): string {
  if (typeof schema !== "object" || schema === null) return "";
  const unit = (schema as Record<string, unknown>)["x-unit"];
  if (typeof unit === "string") return unit;
  for (const value of Object.values(schema)) {
    const inner = unitOf(value);
    if (inner) return inner;
  }
  return "";
}

/** The columns that come lowest, at most `count` of them. */
export function lowest(columns: Columns, count: number): Columns {
  const least = columns.values.map((values) =>
    values.reduce<number>((low, value) => (value !== null && value < low ? value : low), Infinity));
  const order = columns.names.map((_, i) => i).sort((a, b) => least[a]! - least[b]!).slice(0, count);
  return { ...columns, names: order.map((i) => columns.names[i]!), values: order.map((i) => columns.values[i]!) };
}

/** Backward differences per second, one row shorter information-wise: the first row is null. */
export function rates(columns: Columns): Columns {
  const values = columns.values.map((column) => column.map((value, i) => {
    const before = i > 0 ? column[i - 1] : null;
    const step = i > 0 ? columns.times[i]! - columns.times[i - 1]! : 0;
    return value === null || before === null || before === undefined || step <= 0 ? null : (value - before) / step;
  }));
  return { ...columns, values, unit: columns.unit ? `${columns.unit}/s` : "" };
}
