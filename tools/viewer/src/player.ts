// SPDX-License-Identifier: BSD-3-Clause
import { byId, element, icon } from "./page";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const kPlay = "M7 4v16l13-8z", kPause = "M6 4h4v16H6zM14 4h4v16h-4z";
const kStepBack = "M6 4h3v16H6zM19 4v16L9 12z", kStepForth = "M5 4v16l10-8zM15 4h3v16h-3z";

/** Time as the user moves it: buttons, keys, speed. Views learn of it through `show`. */
export class Player {
  time = 0;
  start = 0;
  end = 0;
  playing = false;
  /** Live: the end is where we are, until somebody looks back. */
  following = false;
  /** Times of the frames (s), for single steps. */
  frames: ArrayLike<number> = [];
  private speed = 1;
  private last = 0;
  private readonly speeds = byId<HTMLSelectElement>("speed");

  constructor(private readonly show: (time: number) => void) {
    for (const speed of kSpeeds) {
      const option = element("option", "", `${speed} ×`);
      option.value = String(speed);
      this.speeds.append(option);
    }
    this.speeds.value = "1";
    this.speeds.onchange = () => (this.speed = Number(this.speeds.value));
    byId("back").append(icon(kStepBack));
    byId("forth").append(icon(kStepForth));
    byId("back").onclick = () => this.step(-1);
    byId("forth").onclick = () => this.step(1);
    byId("play").onclick = () => this.toggle();
    this.drawButton();
  }

  seek(time: number): void {
    this.following = false;
    this.set(time);
  }

  set(time: number): void {
    this.time = Math.min(this.end, Math.max(this.start, time));
    this.show(this.time);
  }

  toggle(): void {
    this.playing = !this.playing;
    if (this.playing && this.time >= this.end && !this.following) this.set(this.start);
    this.drawButton();
  }

  pause(): void {
    this.playing = false;
    this.drawButton();
  }

  step(direction: number): void {
    this.pause();
    let to = direction > 0 ? this.end : this.start;
    for (let i = 0; i < this.frames.length; ++i) {
      const frame = this.frames[i]!;
      if (direction < 0 && frame < this.time - 1e-9) to = frame;
      if (direction > 0 && frame > this.time + 1e-9) { to = frame; break; }
    }
    this.seek(to);
  }

  faster(steps: number): void {
    const index = kSpeeds.indexOf(this.speed) + steps;
    this.speed = kSpeeds[Math.min(kSpeeds.length - 1, Math.max(0, index))]!;
    this.speeds.value = String(this.speed);
  }

  /** Called with every picture; `now` in ms. */
  tick(now: number): void {
    const elapsed = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (!this.playing || this.following) return;
    const next = this.time + elapsed * this.speed;
    this.set(next);
    if (next >= this.end) this.pause();
  }

  private drawButton(): void {
    byId("play").replaceChildren(icon(this.playing ? kPause : kPlay));
    byId("play").setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }
}
