// SPDX-License-Identifier: BSD-3-Clause
// What every source fills and every view reads: messages by topic and time.

const decoder = new TextDecoder();

/** One topic: times in s since the start, and messages that are decoded when somebody looks. */
export class Topic {
  readonly times: number[] = [];
  private readonly data: Uint8Array[] = [];
  private cachedIndex = -1;
  private cached: unknown;
  private dropped = 0;

  constructor(readonly name: string, readonly schemaName: string, readonly schema: unknown) {}

  get length(): number { return this.times.length; }
  /** Messages that were here and are forgotten; index + this counts from the start. */
  get forgotten(): number { return this.dropped; }

  add(time: number, data: Uint8Array): void {
    this.times.push(time);
    this.data.push(data);
  }

  message(index: number): unknown {
    if (this.cachedIndex !== index) {
      this.cached = JSON.parse(decoder.decode(this.data[index]));
      this.cachedIndex = index;
    }
    return this.cached;
  }

  /** Index of the last message at or before `time`, -1 if there is none. */
  indexAt(time: number): number {
    return upperBound(this.times, time + 1e-9) - 1;
  }

  /** Forgets what lies before `time`, save the last such message. */
  forgetBefore(time: number): void {
    const keepFrom = this.indexAt(time);
    if (keepFrom <= 0) return;
    this.times.splice(0, keepFrom);
    this.data.splice(0, keepFrom);
    this.dropped += keepFrom;
    this.cachedIndex = -1;
  }
}

/** Index of the first of the sorted `values` that is above `value`. */
export function upperBound(values: ArrayLike<number>, value: number): number {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle]! <= value) low = middle + 1; else high = middle;
  }
  return low;
}

export class Recording {
  readonly topics = new Map<string, Topic>();
  readonly metadata = new Map<string, Map<string, string>>();
  readonly attachments = new Map<string, Uint8Array>();
  /** What went wrong while reading, in words for the user. */
  readonly warnings: string[] = [];
  start = 0;
  end = 0;
  private epoch: bigint | undefined;

  topic(name: string, schemaName = "", schema: unknown = undefined): Topic {
    let topic = this.topics.get(name);
    if (!topic) this.topics.set(name, topic = new Topic(name, schemaName, schema));
    return topic;
  }

  /** `epoch` is the time stamp (ns) of time 0; the first message's if nobody says. */
  setEpoch(epoch: bigint): void { this.epoch = epoch; }

  add(topic: Topic, stamp: bigint, data: Uint8Array): number {
    this.epoch ??= stamp;
    const time = Number(stamp - this.epoch) * 1e-9;
    const last = topic.times.at(-1);
    if (last !== undefined && time < last) return last;  // a server that ran before: not this run
    topic.add(time, data);
    this.end = Math.max(this.end, time);
    return time;
  }

  /** A value of metadata `oca`, or of another map. */
  about(key: string, map = "oca"): string | undefined { return this.metadata.get(map)?.get(key); }

  /** The last message of a topic. */
  last(name: string): unknown {
    const topic = this.topics.get(name);
    return topic && topic.length > 0 ? topic.message(topic.length - 1) : undefined;
  }

  forgetBefore(time: number): void {
    if (time <= this.start) return;
    this.start = time;
    for (const topic of this.topics.values()) {
      if (!topic.name.startsWith("/scene/robots")) topic.forgetBefore(time);
    }
  }
}
