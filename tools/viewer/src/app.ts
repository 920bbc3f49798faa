// SPDX-License-Identifier: BSD-3-Clause
import { columnsOf } from "./columns";
import { dragObstacles } from "./drag";
import { Knobs } from "./knobs";
import { limitsOf } from "./limits";
import { LiveSource } from "./live_source";
import { bindKeys } from "./keys";
import type { Layer } from "./overlays";
import type { RunReport } from "./messages";
import { byId, element, type Page } from "./page";
import { badges, limits, logLines, parameters, reportOf, showWarnings, summary, warningsOf } from "./panels";
import { Player } from "./player";
import { Plots } from "./plots";
import { nearnessOf } from "./nearness";
import { Recording } from "./recording";
import { SceneView } from "./scene_view";
import { makeSwitches, markSwitch, Tabs } from "./tabs";
import { Timeline } from "./timeline";

const kSwitches: [layer: Layer, name: string][] = [
  ["distances", "Distances"], ["forces", "Forces"], ["torques", "Torques"], ["requested", "Requested path"],
  ["actual", "Actual path"], ["labels", "Labels"],
];
const kTabs = ["Plots", "Summary", "Limits", "Parameters", "Log"] as const;
type Tab = (typeof kTabs)[number];
const kNear = 0.3;             // m; from where on a distance counts as near, where no field says it
const kLivePast = 60;          // s that a live page remembers
const kLiveRefresh = 250;      // ms between refreshes of the plots of a live page
const kLiveSaid = 1000;        // ms between those of its words

/** The page: puts a recording into the scene, the plots and the tabs, and moves them together. */
export class App {
  readonly view: SceneView;
  readonly player: Player;
  plots: Plots | undefined;
  recording = new Recording();
  private readonly timeline: Timeline;
  private readonly tabs: Tabs<Tab>;
  private live: LiveSource | undefined;

  constructor(readonly page: Page) {
    this.view = new SceneView(page, byId("view"), byId("labels"), this.recording);
    this.player = new Player((time) => this.show(time));
    this.timeline = new Timeline(page, (time) => this.player.seek(time));
    this.tabs = new Tabs(kTabs, () => { if (this.live) this.refreshSaid(); });
    makeSwitches(kSwitches, (layer) => this.turn(layer), (layer) => this.view.overlays.isOn(layer));
    bindKeys(this);
    page.onTheme(() => this.plots?.refresh());
    const loop = (now: number): void => {
      this.player.tick(now);
      this.view.render();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  /** Shows a finished record. */
  load(recording: Recording): void {
    this.take(recording);
    const nearest = reportOf(recording).metrics?.["min_distance_time"];
    this.player.set(typeof nearest === "number" ? nearest : recording.start);
  }

  /** Shows a simulator while it runs. */
  follow(url: string): void {
    const live = new LiveSource(url, {
      start: (recording) => this.beginLive(recording),
      about: () => this.aboutChanged(),
      parameters: (list) => knobs.show(list),
      connection: (text) => this.page.message(text),
      notice: (text, kind) => this.page.notice(text, kind),
    });
    this.live = live;
    const pane = element("div", "knobs");
    this.tabs.pane("Parameters").replaceChildren(pane);
    const knobs = new Knobs(pane, live);
    dragObstacles(this.view, live);
    byId("follow").hidden = false;
    byId("follow").onclick = () => (this.player.following = true);
    setInterval(() => this.refreshLive(), kLiveRefresh);
    setInterval(() => this.refreshSaid(), kLiveSaid);
    const loop = (): void => {
      if (this.player.following && this.recording.end !== this.player.time) {
        this.player.end = this.recording.end;
        this.player.set(this.recording.end);
      }
      requestAnimationFrame(loop);
    };
    loop();
  }

  show(time: number): void {
    this.view.show(time);
    this.plots?.show(time);
    this.timeline.show(time, this.player.start, this.player.end);
    byId("clock").textContent = `${time.toFixed(2)} / ${this.player.end.toFixed(2)} s`;
    byId("follow").classList.toggle("on", this.player.following);
  }

  turn(layer: Layer, on = !this.view.overlays.isOn(layer)): void {
    this.view.overlays.turn(layer, on);
    this.view.touch();
    markSwitch(layer, on);
  }

  selectNumber(index: number): void { this.tabs.selectNumber(index); }

  private take(recording: Recording): void {
    this.recording = recording;
    this.view.reset(recording);
    this.player.start = recording.start;
    this.player.end = recording.end;
    this.player.frames = recording.topics.get("/tf")?.times ?? [];
    this.makePlots();
    const report = reportOf(recording);
    const title = recording.about("name") ?? report.name ?? recording.about("diagram") ?? "OCA";
    document.title = `${title} – OCA`;
    byId("title").textContent = title.replace(/^.*\//, "").replace(/\.ya?ml$/, "");
    byId("subtitle").textContent = recording.about("description") ?? "";
    this.showBadges(report);
    if (!this.live) this.fill("Parameters", (pane) => parameters(pane, recording));
    this.filled.clear();
    for (const tab of ["Summary", "Limits", "Log"] as const) this.refill(tab, report);
  }

  /** Puts into a tab what it says of the recording by now, if that is something else. */
  private refill(tab: Tab, report: RunReport): void {
    const { recording } = this, seek = (time: number): void => this.player.seek(time);
    const log = recording.topics.get("/log");
    const said = tab === "Summary" ? JSON.stringify(report) : tab === "Log" ? String((log?.forgotten ?? 0) + (log?.length ?? 0)) : String(recording.end);
    if (this.filled.get(tab) === said) return;
    this.filled.set(tab, said);
    if (tab === "Summary") this.fill(tab, (pane) => summary(pane, recording, report, seek));
    if (tab === "Limits") this.fill(tab, (pane) => limits(pane, recording, limitsOf(recording, this.plots!.specs), seek));
    if (tab === "Log") this.fill(tab, (pane) => logLines(pane, recording, seek));
  }

  /** The tab that is seen, and the badges; not what somebody presses just now. */
  private refreshSaid(): void {
    if (!this.plots) return;
    const report = reportOf(this.recording);
    this.showBadges(report);
    for (const [tab, pane] of this.tabs.panes) {
      if (!pane.hidden && !pane.matches(":active")) this.refill(tab, report);
    }
  }

  private showBadges(report: RunReport): void {
    const warnings = warningsOf(this.recording);
    byId("badges").replaceChildren(...badges(report, this.recording.about("outcome"), warnings.length));
    showWarnings(byId("warnings"), warnings);
  }

  private makePlots(): void {
    this.plotsAsked = this.recording.about("plots", "oca.plots");
    const pane = this.tabs.pane("Plots");
    pane.replaceChildren();
    this.plots = new Plots(this.page, pane, this.recording, (time) => this.player.seek(time));
    const distances = this.plots.specs.find((spec) => spec.role === "distance");
    if (distances?.limit !== undefined) this.view.overlays.limit = distances.limit;
    this.setNearness();
  }

  private setNearness(): void {
    const distances = this.plots?.specs.find((spec) => spec.role === "distance");
    const all = (distances?.signals ?? []).flatMap((name) => this.recording.topics.get(name) ?? []).map(columnsOf);
    const scale = Number(this.recording.about("scale", "oca.parameters") ?? 1) || 1;
    this.timeline.setNearness(nearnessOf(all, distances?.limit ?? kNear * scale));
  }

  private beginLive(recording: Recording): void {
    this.topicsSeen = 0;
    this.take(recording);
    this.player.following = true;
  }

  private refreshLive(): void {
    this.recording.forgetBefore(this.recording.end - kLivePast);
    this.player.start = this.recording.start;
    this.player.end = this.recording.end;
    const wanted = [...this.recording.topics.values()].filter((topic) => topic.length > 0).length;
    if (wanted !== this.topicsSeen) {
      this.topicsSeen = wanted;
      this.take(this.recording);
    } else {
      this.plots?.refresh();
      this.setNearness();
    }
    if (!this.player.following) this.show(this.player.time);
  }
  private topicsSeen = 0;
  private readonly filled = new Map<Tab, string>();  // what a tab says, in short
  private plotsAsked: string | undefined;

  /** A change of parameters made the diagram anew: warnings and plots may be others. */
  private aboutChanged(): void {
    this.showBadges(reportOf(this.recording));
    if (this.plots && this.recording.about("plots", "oca.plots") !== this.plotsAsked) this.makePlots();
  }

  private fill(tab: Tab, into: (pane: HTMLElement) => void): void {
    const pane = this.tabs.pane(tab);
    pane.replaceChildren();
    into(pane);
  }

  static readonly layers = kSwitches.map(([layer]) => layer);
}
