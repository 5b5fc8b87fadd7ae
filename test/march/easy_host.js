// SPDX-License-Identifier: MIT
// The host code of doc/library/glsl.md, run by Node: node easy_host.js CHECKOUT/doc/library/glsl.md
'use strict';
const assert = require('assert');
const fs = require('fs');

const code = fs.readFileSync(process.argv[2], 'utf8').match(/\n```js\n([^]*?)```\n/)[1];
const {maximumLevels, fillEasyTextures} = new Function(code + '; return {maximumLevels, fillEasyTextures};')();

// Every block of every level against its nodes.
function checkLevels(heights, cols, rows) {
  const levels = maximumLevels(heights, cols, rows);
  levels.forEach(({width, height, texels}, level) => {
    assert.strictEqual(texels.length, width * height);
    assert.strictEqual(width, Math.max(levels[0].width >> level, 1));
    assert.strictEqual(height, Math.max(levels[0].height >> level, 1));
    for (let row = 0; row << level < rows - 1; ++row) {
      for (let col = 0; col << level < cols - 1; ++col) {
        let most = -Infinity;
        for (let r = row << level; r <= Math.min((row + 1) << level, rows - 1); ++r)
          for (let c = col << level; c <= Math.min((col + 1) << level, cols - 1); ++c)
            most = Math.max(most, heights[r * cols + c]);
        assert.strictEqual(texels[row * width + col], most, `${cols} x ${rows}, level ${level}: ${col}, ${row}`);
      }
    }
  });
  const top = levels[levels.length - 1];
  assert.strictEqual(top.width * top.height, 1);
  assert.ok(levels[0].width >= cols - 1 && levels[0].height >= rows - 1);
}

for (const [cols, rows] of [[2, 2], [3, 2], [2, 9], [5, 5], [6, 4], [17, 16], [14, 61], [70, 3]])
  checkLevels(Float32Array.from({length: cols * rows}, (_, i) => -100 + (i * 7919) % 97), cols, rows);

// What WebGL receives.
const calls = [];
const gl = new Proxy({}, {
  get: (_, name) => (/^[A-Z]/.test(name) ? name : (...values) => {
    calls.push([name, ...values]);
    return name;
  }),
});
gl.TEXTURE0;
fillEasyTextures(gl, 'program', new Float32Array(12), 4, 3);
const images = calls.filter(([name]) => name === 'texImage2D').map((call) => call.slice(2, 6));
assert.deepStrictEqual(images, [[0, 'R32F', 4, 3], [0, 'R32F', 4, 2], [1, 'R32F', 2, 1], [2, 'R32F', 1, 1]]);
