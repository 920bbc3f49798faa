// node make.js FILE NAME=TEXT...: an MCAP file of these attachments.
const fs = require('fs');
const u32 = (n) => { const b = Buffer.alloc(4); b.writeUInt32LE(n); return b; };
const u64 = (n) => { const b = Buffer.alloc(8); b.writeBigUInt64LE(BigInt(n)); return b; };
const text = (s) => Buffer.concat([u32(Buffer.byteLength(s)), Buffer.from(s)]);
const record = (op, body) => Buffer.concat([Buffer.from([op]), u64(body.length), body]);
const magic = Buffer.from('\x89MCAP0\r\n', 'latin1');
const [out, ...attachments] = process.argv.slice(2);
const parts = [magic, record(1, Buffer.concat([text(''), text('oca')]))];
for (const item of attachments) {
  const at = item.indexOf('='), data = Buffer.from(item.slice(at + 1));
  parts.push(record(9, Buffer.concat([u64(0), u64(0), text(item.slice(0, at)), text(''), u64(data.length), data, u32(0)])));
}
parts.push(record(15, u32(0)), record(2, Buffer.concat([u64(0), u64(0), u32(0)])), magic);
fs.writeFileSync(out, Buffer.concat(parts));
