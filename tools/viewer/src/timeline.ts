// SPDX-License-Identifier: BSD-3-Clause
import type { Nearness } from "./nearness";
import { byId, type Page } from "./page";

/** The bar under everything: time, and along it how near the arm came. */
export class Timeline {
  private readonly root = byId("timeline");
  private readonly canvas = this.root.querySelector("canvas")!;
  private start = 0;
  private end = 0;
  private time = 0;
  private nearness: Nearness = { times: [], values: [], shares: [] };

  constructor(private readonly page: Page, seek: (time: number) => void) {
    const toTime = (event: PointerEvent): void => {
      const box = this.canvas.getBoundingClientRect();
      seek(this.start + ((event.clientX - box.left) / box.width) * (this.end - this.start));
    };
    this.root.onpointerdown = (event) => {
      this.root.setPointerCapture(event.pointerId);
      toTime(event);
    };
    this.root.onpointermove = (event) => {
      if (event.buttons & 1) toTime(event);
    };
    new ResizeObserver(() => this.draw()).observe(this.root);
    page.onTheme(() => this.draw());
  }

  setNearness(nearness: Nearness): void { this.nearness = nearness; }

  show(time: number, start: number, end: number): void {
    [this.time, this.start, this.end] = [time, start, end];
    this.root.setAttribute("aria-valuemax", end.toFixed(2));
    this.root.setAttribute("aria-valuenow", time.toFixed(2));
    this.draw();
  }

  private draw(): void {
    const ratio = devicePixelRatio, width = this.root.clientWidth, height = this.root.clientHeight;
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const ctx = this.canvas.getContext("2d")!;
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, width, height);
    const x = (time: number): number => ((time - this.start) / Math.max(1e-9, this.end - this.start)) * width;
    const track = height - 16;
    ctx.fillStyle = this.page.colour("--track");
    ctx.fillRect(0, 0, width, track);
    this.drawNearness(ctx, x, track);
    this.drawTicks(ctx, x, width, track, height);
    ctx.fillStyle = this.page.colour("--accent");
    ctx.fillRect(Math.min(Math.max(x(this.time) - 1.25, 0), width - 2.5), 0, 2.5, track);
    ctx.beginPath();
    ctx.arc(Math.min(Math.max(x(this.time), 5), width - 5), track / 2, 6, 0, 2 * Math.PI);
    ctx.fill();
  }

  /** The nearer, the higher the bar; where nothing is near it is low and pale. */
  private drawNearness(ctx: CanvasRenderingContext2D, x: (time: number) => number, track: number): void {
    const { times, values, shares } = this.nearness;
    for (let i = 0; i < times.length; ++i) {
      const share = shares[i]!;
      if (!Number.isFinite(share)) continue;
      const left = x(times[i]!), right = i + 1 < times.length ? x(times[i + 1]!) : left + 1;
      const height = Math.min(1, Math.max(0.04, 1 - share / 2));
      ctx.fillStyle = this.page.colour(values[i]! <= 0 ? "--bad" : share < 1 ? "--warn" : "--calm");
      ctx.fillRect(left, track * (1 - height), Math.max(0.6, right - left + 0.3), track * height);
    }
  }

  private drawTicks(ctx: CanvasRenderingContext2D, x: (time: number) => number, width: number, track: number, height: number): void {
    const span = this.end - this.start;
    if (span <= 0) return;
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60, 120, 600].find((one) => (one / span) * width > 46) ?? 3600;
    ctx.fillStyle = this.page.colour("--text-dim");
    ctx.font = `10.5px ${this.page.font}`;
    for (let tick = Math.ceil(this.start / step) * step; tick <= this.end + 1e-9; tick += step) {
      const at = x(tick);
      ctx.textAlign = at < 10 ? "left" : at > width - 14 ? "right" : "center";
      ctx.fillText(`${Number(tick.toFixed(2))} s`, at, height - 3);
      ctx.fillRect(at - 0.5, track, 1, 4);
    }
  }
}
