// SPDX-License-Identifier: BSD-3-Clause
import { FoxgloveClient, type ParameterValue } from "@foxglove/ws-protocol";
import { Recording, type Topic } from "./recording";

export interface Parameter { name: string; value: ParameterValue }
export type NoticeKind = "info" | "warning" | "error";
export interface LiveEvents {
  /** A run (or another one) begins. */
  start(recording: Recording): void;
  /** The metadata of the recording are others now. */
  about(): void;
  parameters(list: Parameter[]): void;
  /** Why nothing comes; empty: all is well. */
  connection(text: string): void;
  /** Said by the server. */
  notice(text: string, kind: NoticeKind): void;
}

const kRetryAfter = 1000;  // ms
const kJump = 1_000_000_000n;  // ns that time goes back by if it is another run
const kKinds: NoticeKind[] = ["info", "warning", "error"];

/** What one connection subscribed to. */
interface Subscription { topic: Topic; latest: bigint }

/** Follows a running simulator that speaks foxglove.websocket.v1. Comes back when it does, and
    begins anew if it is another run then: another session, or time that went back. */
export class LiveSource {
  recording = new Recording();
  private client: FoxgloveClient | undefined;
  private open = false;
  private session = "";
  private parameters: Parameter[] = [];

  constructor(private readonly url: string, private readonly events: LiveEvents) { this.connect(); }

  /** Takes effect at the simulator's next tick; one that is refused comes back as it was. */
  set(name: string, value: ParameterValue): void {
    if (this.client && this.open) {
      this.client.setParameters([{ name, value }] as Parameters<FoxgloveClient["setParameters"]>[0], "set");
    } else {
      this.events.notice(`${name} was not changed: the simulator is gone.`, "error");
      this.events.parameters(this.parameters);
    }
  }

  /** The parameter that says where an obstacle is, `left.obstacles.box.position`; of several obstacles of that id the first one's. */
  positionOf(id: string): string {
    const position = `${id}.position`;
    return this.parameters.find(({ name }) => name.endsWith(`.${position}`))?.name ?? position;
  }

  private connect(): void {
    const client = new FoxgloveClient({ ws: new WebSocket(this.url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
    const subscriptions = new Map<number, Subscription>();
    let greeted = false;
    this.client = client;
    client.on("open", () => (this.open = true));
    client.on("serverInfo", (info) => {
      const session = info.sessionId ?? "";
      const another = session !== this.session || (session === "" && !greeted);
      if (another) this.begin();
      this.session = session;
      for (const [name, value] of Object.entries(info.metadata ?? {})) this.about(name, value);
      if (!another) this.events.about();
      if (!greeted && info.capabilities.includes("parametersSubscribe")) client.subscribeParameterUpdates([]);
      if ((!greeted || another) && info.capabilities.includes("parameters")) client.getParameters([], "all");
      greeted = true;
      this.events.connection("");
    });
    client.on("advertise", (channels) => {
      for (const channel of channels) {
        if (channel.encoding !== "json") continue;
        const topic = this.recording.topic(channel.topic, channel.schemaName, parse(channel.schema));
        subscriptions.set(client.subscribe(channel.id), { topic, latest: 0n });
      }
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => {
      const subscription = subscriptions.get(subscriptionId);
      if (!subscription) return;
      if (timestamp + kJump < subscription.latest) {
        this.session = "";  // whatever it is called: begin anew
        return client.close();
      }
      subscription.latest = timestamp;
      this.recording.add(subscription.topic, timestamp, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    });
    client.on("parameterValues", ({ parameters }) => this.take(parameters));
    client.on("status", ({ level, message }) => this.events.notice(message, kKinds[level] ?? "info"));
    client.on("close", () => {
      const refused = !this.open;
      this.open = false;
      this.events.connection("The simulator is gone; this is what it sent.");
      if (refused) void this.askWhy();
      setTimeout(() => this.connect(), kRetryAfter);
    });
    client.on("error", () => undefined);  // a close follows
  }

  /** A browser does not tell why a WebSocket was refused; a page is. */
  private async askWhy(): Promise<void> {
    const answer = await fetch(this.url.replace(/^ws/, "http"), { cache: "no-store" }).catch(() => undefined);
    if (answer?.status !== 403 || this.open) return;
    this.events.connection("Another simulator runs here now and does not let this page in: open the address that it printed.");
  }

  private take(parameters: { name: string; value: ParameterValue }[]): void {
    const values = new Map(this.parameters.map(({ name, value }) => [name, value]));
    const map = this.recording.metadata.get("oca.parameters") ?? new Map<string, string>();
    for (const { name, value } of parameters) {
      values.set(name, value);
      map.set(name, String(value));
    }
    this.recording.metadata.set("oca.parameters", map);
    this.parameters = [...values].map(([name, value]) => ({ name, value }));
    this.events.parameters(this.parameters);
  }

  private begin(): void {
    this.recording = new Recording();
    this.parameters = [];
    this.events.start(this.recording);
  }

  /** `oca.plots/plots` is key `plots` of the record's metadata `oca.plots`. */
  private about(name: string, value: string): void {
    const slash = name.indexOf("/");
    const [map, key] = slash < 0 ? ["oca", name] : [name.slice(0, slash), name.slice(slash + 1)];
    this.recording.metadata.set(map, (this.recording.metadata.get(map) ?? new Map<string, string>()).set(key, value));
    if (map === "oca" && key === "start_epoch_ns" && /^\d+$/.test(value)) this.recording.setEpoch(BigInt(value));
  }
}

function parse(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}
