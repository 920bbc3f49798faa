// SPDX-License-Identifier: BSD-3-Clause
// How near the arm came, at each time.
import { upperBound } from "./recording";
import type { Columns } from "./columns";

/** Of all pairs the least distance (m), and the least as a share of what is near for its pair. */
export interface Nearness { times: number[]; values: number[]; shares: number[] }

/**
 * A pair is near within `limit`, m. One that is never far, as links that stand beside each other by design, is so within a third
 * of its largest distance: else it would hide all others. What is not measured is far.
 */
export function nearnessOf(all: Columns[], limit: number): Nearness {
  const times = all[0]?.times ?? [];
  const pairs = all.flatMap(({ times: own, values }) => values.map((distances) => {
    const farthest = distances.reduce<number>((most, one) => Math.max(most, one ?? Infinity), 0);
    return { own, distances, near: Math.max(Math.min(limit, farthest / 3), 1e-9) };
  }));
  const values: number[] = [], shares: number[] = [];
  for (const time of times) {
    let low = Infinity, share = Infinity;
    for (const { own, distances, near } of pairs) {
      const distance = distances[upperBound(own, time + 1e-9) - 1] ?? Infinity;
      low = Math.min(low, distance);
      share = Math.min(share, distance / near);
    }
    values.push(low);
    shares.push(share);
  }
  return { times, values, shares };
}
