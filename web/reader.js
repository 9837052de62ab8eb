'use strict';
// Reads the container: "RLVW", version, JSON, blocks. Every refusal names the block.

const VERSION = 1;

const CRC_TABLE = Uint32Array.from({length: 256}, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});

function crc32(bytes) {
  let crc = ~0;
  for (let i = 0; i < bytes.length; i++) crc = CRC_TABLE[(crc ^ bytes[i]) & 255] ^ (crc >>> 8);
  return ~crc >>> 0;
}

function bytesOfBase64(text) {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// Returns {meta, block(name)}. block gives the stored bytes after all checks.
function readContainer(bytes) {
  const head = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 12 || String.fromCharCode(...bytes.subarray(0, 4)) !== 'RLVW')
    throw Error('The data of this page is damaged: it has no header.');
  const version = head.getUint32(4, true), length = head.getUint32(8, true);
  if (version !== VERSION) throw Error(`The data has version ${version}; this page reads ${VERSION}.`);
  if (12 + length > bytes.length) throw Error('The data of this page is cut: its description is incomplete.');
  let meta;
  try {
    meta = JSON.parse(new TextDecoder('utf-8', {fatal: true}).decode(bytes.subarray(12, 12 + length)));
  } catch (_) {
    throw Error('The data of this page is damaged: its description cannot be read.');
  }
  const first = 12 + length;
  const find = name => meta.blocks.find(b => b.name === name);
  for (const b of meta.blocks) {
    if (!(b.offset >= 0 && b.length >= 0 && first + b.offset + b.length <= bytes.length))
      throw Error(`Block "${b.name}" ends past the end of the data.`);
    if (crc32(bytes.subarray(first + b.offset, first + b.offset + b.length)) !== b.crc32)
      throw Error(`Block "${b.name}" is damaged: its checksum differs.`);
  }
  return {meta, find, block(name) {
    const b = find(name);
    if (!b) throw Error(`Block "${name}" is missing.`);
    return bytes.subarray(first + b.offset, first + b.offset + b.length);
  }};
}

// The raw bytes of a block: as many as `size`, in the table and as expected.
async function inflated(container, name, size) {
  const b = container.find(name), stored = container.block(name);
  if (b.size !== size) throw Error(`Block "${name}" has ${b.size} bytes instead of ${size}.`);
  if (b.coding === 'raw') return stored;
  if (b.coding !== 'deflate') throw Error(`Block "${name}" has the unknown coding "${b.coding}".`);
  const raw = new Uint8Array(size);
  let filled = 0;
  try {
    const reader = new Blob([stored]).stream().pipeThrough(new DecompressionStream('deflate')).getReader();
    for (;;) {
      const {done, value} = await reader.read();
      if (done) break;
      if (filled + value.length > size) throw Error('too long');
      raw.set(value, filled);
      filled += value.length;
    }
  } catch (_) {
    throw Error(`Block "${name}" cannot be unpacked.`);
  }
  if (filled !== size) throw Error(`Block "${name}" unpacks to ${filled} bytes instead of ${size}.`);
  return raw;
}

// Heights in metres, row by row from the first; NaN where there are none.
async function readHeights(container) {
  const {size: [columns, rows], height} = container.meta, count = columns * rows;
  const raw = await inflated(container, 'heights', 2 * count);
  const stored = new Uint16Array(count), metres = new Float32Array(count);
  for (let r = 0, i = 0; r < rows; r++)
    for (let c = 0; c < columns; c++, i++) {
      const left = c ? stored[i - 1] : 0, up = r ? stored[i - columns] : 0;
      const both = c && r ? stored[i - columns - 1] : 0;
      const v = stored[i] = left + up - both + raw[i] + 256 * raw[count + i];
      metres[i] = (v & 65535) === 65535 ? NaN : height.min + height.step * (v & 65535);
    }
  return metres;
}

async function readFar(container) {
  const far = container.meta.far;
  if (!far || !container.find('far')) return null;
  const count = far.columns * far.rows * far.azimuths, raw = await inflated(container, 'far', 2 * count);
  const angle = Float32Array.from(new Int16Array(raw.slice().buffer), v => v / 100);
  const least = 1 / Math.max(...container.meta.size.map((n, i) => n * container.meta.step_m[i] / (far.columns - 1)));
  const steps = await inflated(container, 'far_steps', count);
  return {...far, angle, nearness: Float32Array.from(steps, v => v === 255 ? 0 : Math.min(least, 1 / (far.nearest_m * far.step ** v)))};
}
