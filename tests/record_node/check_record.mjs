// SPDX-License-Identifier: BSD-3-Clause
// Reads records with @mcap/core and judges their messages by @foxglove/schemas: nothing here is
// OCA's. Usage: node check_record.mjs FILE.mcap... ; exit status 1 if anything is wrong.
import { readFileSync } from "node:fs";
import { open } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import * as foxglove from "@foxglove/schemas/jsonschema.js";
import Ajv from "ajv";

const decompressHandlers = await loadDecompressHandlers();
const text = (bytes) => new TextDecoder().decode(bytes);
let faults = 0;
function fault(file, what) {
  console.error(`${file}: ${what}`);
  faults += 1;
}

class File {
  constructor(handle) {
    this.handle = handle;
  }
  async size() {
    return BigInt((await this.handle.stat()).size);
  }
  async read(offset, length) {
    const buffer = new Uint8Array(Number(length));
    await this.handle.read(buffer, 0, buffer.length, Number(offset));
    return buffer;
  }
}

const validators = new Map();
/** The published schema of a well-known name, else the one in the file. */
function validatorsFor(schema) {
  if (!validators.has(schema.name + text(schema.data))) {
    const list = [JSON.parse(text(schema.data))];
    if (schema.name.startsWith("foxglove.")) {
      const published = foxglove[schema.name.slice("foxglove.".length)];
      if (published === undefined) throw new Error(`no published schema ${schema.name}`);
      list.push(published);
    }
    const ajv = () => new Ajv({ strict: false, allErrors: false });
    validators.set(schema.name + text(schema.data), list.map((item) => ajv().compile(item)));
  }
  return validators.get(schema.name + text(schema.data));
}

function streamed(file, bytes) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  reader.append(bytes);
  let messages = 0;
  for (let record; (record = reader.nextRecord()) !== undefined; ) {
    if (record.type === "Message") messages += 1;
  }
  if (!reader.done()) fault(file, "the stream does not end");
  return messages;
}

async function indexed(file) {
  const handle = await open(file, "r");
  const reader = await McapIndexedReader.Initialize({ readable: new File(handle), decompressHandlers });
  const topics = {};
  let last = 0n;
  let messages = 0;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const value = JSON.parse(text(message.data));
    topics[channel.topic] = (topics[channel.topic] ?? 0) + 1;
    messages += 1;
    if (message.logTime < last) fault(file, `${channel.topic}: time goes back`);
    last = message.logTime;
    for (const valid of validatorsFor(reader.schemasById.get(channel.schemaId))) {
      if (!valid(value)) fault(file, `${channel.topic}: ${JSON.stringify(valid.errors[0])}`);
    }
  }
  const attachments = [];
  for await (const attachment of reader.readAttachments({ validateCrcs: true })) {
    attachments.push(attachment.name);
  }
  const metadata = [];
  for await (const entry of reader.readMetadata()) metadata.push(entry.name);
  await handle.close();
  if (Number(reader.statistics.messageCount) !== messages) fault(file, "statistics: wrong count");
  if (reader.statistics.attachmentCount !== attachments.length) fault(file, "statistics: attachments");
  return { messages, topics, attachments, metadata, chunks: reader.chunkIndexes.length };
}

for (const file of process.argv.slice(2)) {
  try {
    const count = streamed(file, readFileSync(file));
    const found = await indexed(file);
    if (count !== found.messages) fault(file, `${count} messages streamed, ${found.messages} indexed`);
    console.log(JSON.stringify({ file, ...found }));
  } catch (error) {
    fault(file, error.stack);
  }
}
process.exit(faults === 0 ? 0 : 1);
