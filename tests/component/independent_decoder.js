// SPDX-License-Identifier: Apache-2.0
// independent_decoder.js CAPTURE: the same lines as decode_velodyne (without the time), by @foxglove/velodyne-cloud.
const fs = require("fs");
const { Calibration, PointCloud, RawPacket, Transformer } = require("@foxglove/velodyne-cloud");

const bytes = fs.readFileSync(process.argv[2]);
const TO_PAYLOAD = 16 + 14 + 20 + 8;
const PAYLOAD = 1206;
let transformer;
const lines = [];
for (let at = 24, number = 0; at + TO_PAYLOAD + PAYLOAD <= bytes.length; at += TO_PAYLOAD + PAYLOAD, ++number) {
  const raw = new RawPacket(new Uint8Array(bytes.subarray(at + TO_PAYLOAD, at + TO_PAYLOAD + PAYLOAD)));
  if (transformer === undefined) {
    const calibration = new Calibration(raw.inferModel());
    // Where each laser sits inside the housing, up to 11 mm from the middle, is no part of the packet.
    for (const laser of calibration.laserCorrections) laser.vertOffsetCorrection = 0;
    transformer = new Transformer(calibration, { minRange: 0.001, maxRange: 200 });
  }
  const cloud = new PointCloud({ stamp: 0, maxPoints: RawPacket.MAX_POINTS_PER_PACKET });
  transformer.unpack(raw, 0, 0, cloud);
  cloud.trim();
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  for (let i = 0; i < cloud.width * cloud.height; ++i) {
    const base = i * cloud.point_step;
    const xyz = [0, 4, 8].map((offset) => view.getFloat32(base + offset, true).toFixed(6));
    lines.push(`${number} ${xyz.join(" ")}`);
  }
}
fs.writeSync(1, lines.join("\n") + "\n");
