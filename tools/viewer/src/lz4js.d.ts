// SPDX-License-Identifier: BSD-3-Clause
declare module "lz4js" {
  const lz4: { decompress(data: Uint8Array, maximum?: number): Uint8Array };
  export default lz4;
}
