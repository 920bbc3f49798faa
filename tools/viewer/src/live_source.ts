// SPDX-License-Identifier: BSD-3-Clause
import { FoxgloveClient, type ParameterValue } from "@foxglove/ws-protocol";
import { Recording, type Topic } from "./recording";

export interface Parameter { name: string; value: ParameterValue }
export interface LiveEvents {
  /** A run (or another one) begins. */
  start(recording: Recording): void;
  parameters(list: Parameter[]): void;
  /** Said by the server or about it; empty: all is well. */
  status(text: string): void;
}

const kRetryAfter = 1000;  // ms

/** Follows a running simulator that speaks foxglove.websocket.v1; comes back when it does. */
export class LiveSource {
  recording = new Recording();
  private client: FoxgloveClient | undefined;
  private session = "";

  constructor(private readonly url: string, private readonly events: LiveEvents) { this.connect(); }

  /** Takes effect at the simulator's next tick. */
  set(name: string, value: ParameterValue): void {
    this.client?.setParameters([{ name, value }] as Parameters<FoxgloveClient["setParameters"]>[0], "set");
  }

  private connect(): void {
    const client = new FoxgloveClient({ ws: new WebSocket(this.url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
    const topics = new Map<number, Topic>();
    this.client = client;
    client.on("serverInfo", (info) => {
      const session = info.sessionId ?? "";
      if (session !== this.session || session === "") this.begin();
      this.session = session;
      for (const [name, value] of Object.entries(info.metadata ?? {})) this.about(name, value);
      if (info.capabilities.includes("parameters")) client.getParameters([], "all");
      if (info.capabilities.includes("parametersSubscribe")) client.subscribeParameterUpdates([]);
      this.events.status("");
    });
    client.on("advertise", (channels) => {
      for (const channel of channels) {
        if (channel.encoding !== "json") continue;
        topics.set(client.subscribe(channel.id), this.recording.topic(channel.topic, channel.schemaName, parse(channel.schema)));
      }
    });
    client.on("message", (message) => {
      const topic = topics.get(message.subscriptionId), { data } = message;
      if (topic) this.recording.add(topic, message.timestamp, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    });
    client.on("parameterValues", ({ parameters }) => {
      for (const { name, value } of parameters) {
        const map = this.recording.metadata.get("oca.parameters") ?? new Map<string, string>();
        this.recording.metadata.set("oca.parameters", map.set(name, String(value)));
      }
      this.events.parameters(parameters.map(({ name, value }) => ({ name, value })));
    });
    client.on("status", ({ message }) => this.events.status(message));
    client.on("close", () => {
      this.events.status("The simulator is gone; this is what it sent.");
      setTimeout(() => this.connect(), kRetryAfter);
    });
    client.on("error", () => undefined);  // a close follows
  }

  private begin(): void {
    this.recording = new Recording();
    this.events.start(this.recording);
  }

  /** `oca.plots/plots` is key `plots` of the record's metadata `oca.plots`. */
  private about(name: string, value: string): void {
    const [map, key] = name.includes("/") ? name.split("/", 2) as [string, string] : ["oca", name];
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
