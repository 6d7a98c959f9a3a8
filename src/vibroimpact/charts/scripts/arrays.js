// Reading of a document with arrays, as vibroimpact.charts.pack writes it.
"use strict";
const vibroimpact = globalThis.vibroimpact = globalThis.vibroimpact || {};

{
  const TYPES = { f4: Float32Array, f8: Float64Array, i4: Int32Array };

  const PLANES = { p4: Float32Array, p8: Float64Array };

  // Return an array whose bytes lie by planes: the first ones of all values, then the second ones, and so on.
  const byPlanes = (buffer, Type, start, length) => {
    const size = Type.BYTES_PER_ELEMENT, planes = new Uint8Array(buffer, start, size * length), bytes = new Uint8Array(size * length);
    for (let plane = 0; plane < size; plane++) for (let index = 0; index < length; index++) bytes[size * index + plane] = planes[plane * length + index];
    return new Type(bytes.buffer);
  };

  // Return the document in an ArrayBuffer.
  vibroimpact.unpack = (buffer) => {
    const length = new DataView(buffer).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    const known = new Map();
    const array = ([type, first, second, third]) => {
      if (type === "texts") return JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4 + length + first, second)));
      if (type === "even") return Float64Array.from({ length: third }, (_, index) => first + second * index);
      const values = type in PLANES ? byPlanes(buffer, PLANES[type], 4 + length + first, second) : new TYPES[type](buffer, 4 + length + first, second);
      values.columns = third || 0;
      return values;
    };
    const filled = (part) => {
      if (Array.isArray(part)) return part.map(filled);
      if (part === null || typeof part !== "object") return part;
      if (!Array.isArray(part.$)) return Object.fromEntries(Object.entries(part).map(([key, value]) => [key, filled(value)]));
      const key = part.$.join();
      if (!known.has(key)) known.set(key, array(part.$));
      return known.get(key);
    };
    return filled(header);
  };

  const fromBase64 = (text) => {
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let index = 0; index < letters.length; index++) bytes[index] = letters.charCodeAt(index);
    return bytes;
  };

  // Return the bytes of a text in base 64 that were compressed by zlib.
  vibroimpact.inflated = async (text) => {
    const bytes = fromBase64(text.trim());
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
  };
}
