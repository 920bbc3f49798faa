// SPDX-License-Identifier: BSD-3-Clause
import type { SceneEntity, SceneUpdate } from "./messages";
import { upperBound, type Topic } from "./recording";

/** The entities of a topic whose messages add, replace and delete them one by one. */
export class EntityHistory {
  private readonly times = new Map<string, number[]>();
  private readonly states = new Map<string, (SceneEntity | null)[]>();
  private read = 0;  // messages, those that were forgotten included

  constructor(private readonly topic: Topic) {}

  get ids(): Iterable<string> { return this.times.keys(); }

  /** Takes in what came since the last call. */
  follow(): void {
    const { topic } = this;
    for (let i = Math.max(0, this.read - topic.forgotten); i < topic.length; ++i) {
      const update = topic.message(i) as SceneUpdate, time = topic.times[i]!;
      for (const deletion of update.deletions ?? []) {
        const ids = deletion.type === 1 ? [...this.times.keys()] : [deletion.id];
        for (const id of ids) this.put(id, time, null);
      }
      for (const entity of update.entities ?? []) this.put(entity.id, time, entity);
    }
    this.read = topic.forgotten + topic.length;
  }

  /** The entity as it is at `time`, null if it is not there. */
  at(id: string, time: number): SceneEntity | null {
    const index = upperBound(this.times.get(id) ?? [], time + 1e-9) - 1;
    return index < 0 ? null : this.states.get(id)![index]!;
  }

  private put(id: string, time: number, state: SceneEntity | null): void {
    if (!this.times.has(id)) {
      this.times.set(id, []);
      this.states.set(id, []);
    }
    this.times.get(id)!.push(time);
    this.states.get(id)!.push(state);
  }
}
