// SPDX-License-Identifier: BSD-3-Clause
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { upperBound, type Recording } from "./recording";
import { columnsFor, plotsOf, type PlotSpec } from "./plot_set";
import { element, type Page } from "./page";

// Colours that the colour-blind tell apart, on light and on dark; dashes tell them apart in print.
const kColours = ["#0072b2", "#d55e00", "#009e73", "#c178a8", "#8a6fd8", "#b8860b", "#3aa0c9", "#777f88"];
const kDashes = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 5], [14, 4], [1, 5], [6, 2, 1, 2]];
const kHeight = 190;

/** The plots of a recording, one below the other, with one cursor that is the time of the scene. */
export class Plots {
  readonly specs: PlotSpec[];
  private readonly charts: uPlot[] = [];
  private time = 0;
  private moving = false;

  constructor(private readonly page: Page, private readonly parent: HTMLElement,
              private readonly recording: Recording, private readonly seek: (time: number) => void) {
    this.specs = plotsOf(recording);
    for (const spec of this.specs) this.addChart(spec);
    if (this.specs.length === 0) parent.append(element("p", "empty", "No signals were recorded."));
    new ResizeObserver(() => this.resize()).observe(parent);
  }

  /** Moves the cursors; a click or drag in a plot comes back through `seek`. */
  show(time: number): void {
    this.time = time;
    this.moving = true;
    for (const chart of this.charts) {
      chart.setCursor({ left: chart.valToPos(time, "x"), top: -10 }, false);
      const times = chart.data[0];
      chart.setLegend({ idx: Math.max(0, Math.min(times.length - 1, upperBound(times, time + 1e-9) - 1)) }, false);
    }
    this.moving = false;
  }

  /** New data or new colours. */
  refresh(): void {
    this.specs.forEach((spec, i) => {
      const columns = columnsFor(spec, this.recording, this.specs);
      if (columns.names.length + 1 === this.charts[i]!.series.length) {
        this.charts[i]!.setData([columns.times, ...columns.values] as uPlot.AlignedData);
      }
    });
    this.show(this.time);
  }

  /** The numbers that a plot draws, for tests. */
  data(title: string): uPlot.AlignedData | undefined {
    return this.charts[this.specs.findIndex((spec) => spec.title === title)]?.data;
  }

  private addChart(spec: PlotSpec): void {
    const columns = columnsFor(spec, this.recording, this.specs);
    const prefix = commonPrefix(columns.names);
    const unit = columns.unit ? ` / ${columns.unit}` : "";
    const colour = (name: string) => () => this.page.colour(name);
    const axis = { stroke: colour("--text-dim"), grid: { stroke: colour("--grid"), width: 1 },
                   ticks: { stroke: colour("--grid"), width: 1 }, font: "11px system-ui, sans-serif" };
    const figure = element("figure", "plot");
    figure.append(element("figcaption", "", `${spec.title}${unit}`));
    if (prefix) figure.firstElementChild!.append(element("small", "", `${prefix}…`));
    this.parent.append(figure);
    const chart = new uPlot({
      width: Math.max(240, this.parent.clientWidth - 24), height: kHeight, padding: [8, 34, 0, 0],
      scales: { x: { time: false }, y: { range: (_, low, high) => rangeOf(spec, low, high) } },
      axes: [{ ...axis, size: 26, values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { ...axis, size: 52 }],
      legend: { live: true },
      cursor: { y: false, drag: { x: false, y: false }, bind: { mousemove: this.onMove, mousedown: this.onDown } },
      series: [
        { label: "t", value: (_, value: number | null | undefined) => (value == null ? "" : `${value.toFixed(2)} s`) },
        ...columns.names.map((name, i) => ({
          label: name.slice(prefix.length) || spec.title, stroke: kColours[i % kColours.length]!, width: 1.6,
          dash: kDashes[i % kDashes.length]!, points: { show: false },
          value: (u: uPlot, value: number | null | undefined) => (value == null ? "–" : short(value, reachOf(u))),
        })),
      ],
      hooks: { draw: [(u) => drawEnds(u, this.page), (u) => drawLimit(u, spec, this.page)] },
    }, [columns.times, ...columns.values] as uPlot.AlignedData, figure);
    this.charts.push(chart);
  }

  private readonly onMove = (chart: uPlot, _: HTMLElement, handler: (event: MouseEvent) => null) =>
    (event: MouseEvent): null => {
      if (event.buttons & 1) this.toMouse(chart, event);
      void handler;
      return null;
    };
  private readonly onDown = (chart: uPlot, _: HTMLElement, handler: (event: MouseEvent) => null) =>
    (event: MouseEvent): null => {
      this.toMouse(chart, event);
      void handler;
      return null;
    };

  private toMouse(chart: uPlot, event: MouseEvent): void {
    if (this.moving) return;
    this.seek(chart.posToVal(event.clientX - chart.over.getBoundingClientRect().left, "x"));
  }

  private resize(): void {
    const width = this.parent.clientWidth - 24;
    if (width < 100) return;
    for (const chart of this.charts) if (chart.width !== width) chart.setSize({ width, height: kHeight });
    this.show(this.time);
  }
}

/** The largest size on the y axis of a plot. */
function reachOf(chart: uPlot): number {
  const { min, max } = chart.scales.y ?? {};
  return Math.max(Math.abs(min ?? 0), Math.abs(max ?? 0));
}

/** Four digits are enough for the eye; what is nothing beside `reach` is 0. */
export function short(value: number, reach = 0): string {
  const size = Math.abs(value);
  if (size < 1e-12 * reach) return "0";
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return value.toExponential(1);
  return value.toFixed(size >= 100 ? 1 : 3);
}

/** What all names begin with, up to an underscore: there is no room to say it seven times. */
function commonPrefix(names: string[]): string {
  const first = names[0] ?? "";
  let end = names.length > 1 ? first.lastIndexOf("_") + 1 : 0;
  while (end > 0 && !names.every((name) => name.startsWith(first.slice(0, end)))) end = first.lastIndexOf("_", end - 2) + 1;
  return names.every((name) => name.length > end) ? first.slice(0, end) : "";
}

function rangeOf(spec: PlotSpec, low: number | null, high: number | null): [number, number] {
  let from = low ?? 0, to = high ?? 1;
  if (spec.role === "distance") from = Math.min(from, 0);
  if (spec.limit !== undefined) to = Math.max(to, spec.limit);
  const margin = (to - from) * 0.06 || Math.max(1e-3, Math.abs(to) * 0.1);
  return [from - margin, to + margin];
}

/** Writes each line's name at its right end, so that nobody has to match colours. */
function drawEnds(u: uPlot, page: Page): void {
  const { ctx, bbox } = u, ratio = devicePixelRatio;
  const ends = u.series.flatMap((series, i) => {
    const last = (u.data[i] as (number | null)[]).findLast((value) => value !== null);
    if (i === 0 || !series.show || last === undefined || last === null) return [];
    return [{ text: String(series.label), y: u.valToPos(last, "y", true), stroke: kColours[(i - 1) % kColours.length]! }];
  }).sort((a, b) => a.y - b.y);
  if (ends.length === 0 || ends.some((end) => end.text.length > 5)) return;
  const gap = 11 * ratio;
  for (let i = 1; i < ends.length; ++i) ends[i]!.y = Math.max(ends[i]!.y, ends[i - 1]!.y + gap);
  let top = bbox.top + bbox.height;
  for (let i = ends.length - 1; i >= 0; --i, top -= gap) ends[i]!.y = Math.min(ends[i]!.y, top);
  ctx.save();
  ctx.font = `600 ${10 * ratio}px ${page.font}`;
  ctx.textBaseline = "middle";
  ctx.textAlign = "left";
  for (const end of ends) {
    ctx.fillStyle = end.stroke;
    ctx.fillText(end.text, bbox.left + bbox.width + 5 * ratio, end.y);
  }
  ctx.restore();
}

function drawLimit(u: uPlot, spec: PlotSpec, page: Page): void {
  const { ctx, bbox } = u, ratio = devicePixelRatio;
  const lines: [number, string, string][] = [];
  if (spec.limit !== undefined) lines.push([spec.limit, `pushes below ${spec.limit} m`, page.colour("--warn")]);
  if (spec.role === "distance") lines.push([0, "contact", page.colour("--bad")]);
  for (const [value, text, stroke] of lines) {
    const y = u.valToPos(value, "y", true);
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = stroke;
    ctx.lineWidth = ratio;
    ctx.setLineDash([3 * ratio, 3 * ratio]);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    ctx.font = `${10 * ratio}px ${page.font}`;
    ctx.textAlign = "right";
    ctx.fillText(text, bbox.left + bbox.width - 4 * ratio, y - 4 * ratio);
    ctx.restore();
  }
}
