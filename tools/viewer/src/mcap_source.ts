// SPDX-License-Identifier: BSD-3-Clause
import { McapIndexedReader, McapStreamReader, type McapTypes } from "@mcap/core";
import { decompress as zstd } from "fzstd";
import lz4 from "lz4js";
import { Recording, type Topic } from "./recording";

type Decompress = (data: Uint8Array, size: bigint) => Uint8Array;

const decompressHandlers: Record<string, Decompress> = {
  zstd: (data, size) => zstd(data, new Uint8Array(Number(size))),
  lz4: (data, size) => new Uint8Array(lz4.decompress(data, Number(size))),
};

/** Reads a whole record. One that was cut is read as far as it goes, with a warning. */
export async function readMcap(bytes: Uint8Array): Promise<Recording> {
  try {
    return await readIndexed(bytes);
  } catch (error) {
    const recording = readStream(bytes);
    if (recording.topics.size === 0) throw error;
    recording.warnings.push("The record was cut; this is what is left of it.");
    return recording;
  }
}

/** The bytes behind base64 text. */
export async function fromBase64(text: string): Promise<Uint8Array> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function readIndexed(bytes: Uint8Array): Promise<Recording> {
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
    },
    decompressHandlers,
  });
  const recording = new Recording();
  for await (const record of reader.readMetadata()) addMetadata(recording, record);
  for await (const record of reader.readAttachments()) recording.attachments.set(record.name, record.data);
  const topics = new Map<number, Topic>();
  for (const channel of reader.channelsById.values()) {
    topics.set(channel.id, addChannel(recording, channel, reader.schemasById.get(channel.schemaId)));
  }
  for await (const message of reader.readMessages()) {
    recording.add(topics.get(message.channelId)!, message.logTime, message.data);
  }
  return recording;
}

function readStream(bytes: Uint8Array): Recording {
  const recording = new Recording();
  const schemas = new Map<number, McapTypes.Schema>();
  const topics = new Map<number, Topic>();
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: false });
  reader.append(bytes);
  try {
    for (let record; (record = reader.nextRecord());) {
      switch (record.type) {
        case "Schema": schemas.set(record.id, record); break;
        case "Channel": topics.set(record.id, addChannel(recording, record, schemas.get(record.schemaId))); break;
        case "Message": recording.add(topics.get(record.channelId)!, record.logTime, record.data); break;
        case "Metadata": addMetadata(recording, record); break;
        case "Attachment": recording.attachments.set(record.name, record.data); break;
      }
    }
  } catch (error) {
    recording.warnings.push(String(error));
  }
  return recording;
}

function addMetadata(recording: Recording, record: McapTypes.Metadata): void {
  recording.metadata.set(record.name, record.metadata);
  const epoch = record.name === "oca" ? record.metadata.get("start_epoch_ns") : undefined;
  if (epoch && /^\d+$/.test(epoch)) recording.setEpoch(BigInt(epoch));
}

function addChannel(recording: Recording, channel: McapTypes.Channel, schema?: McapTypes.Schema): Topic {
  let parsed: unknown;
  try {
    parsed = schema && JSON.parse(new TextDecoder().decode(schema.data));
  } catch {
    recording.warnings.push(`The schema of ${channel.topic} is no JSON.`);
  }
  return recording.topic(channel.topic, schema?.name ?? "", parsed);
}
