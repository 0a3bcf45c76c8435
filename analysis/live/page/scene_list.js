// SPDX-License-Identifier: GPL-3.0-or-later
// The list of the folder's force scenes, with small pictures.

import {get} from './answers.js';
import {make} from './library.js';

const list = document.getElementById('scenes'), count = document.getElementById('scene-count');
const plural = (number, word) => `${number} ${word}${number === 1 ? '' : 's'}`;

/** Pixels 0xRRGGBB, `width` of them in a row, as an image. */
export function imageOf(rgb, width) {
  const canvas = Object.assign(document.createElement('canvas'), {width, height: rgb.length / width});
  const image = new ImageData(width, rgb.length / width);
  const pixels = new Uint32Array(image.data.buffer);  // red comes first
  rgb.forEach((colour, i) => { pixels[i] = 0xff000000 | (colour & 255) << 16 | colour & 0xff00 | colour >> 16; });
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
}

const contents = ({patches, pieces}) => (pieces > 0 ? plural(pieces, 'piece') : `${patches} patch${patches === 1 ? '' : 'es'}`);

async function addPicture(link, index) {
  try {
    const pixels = new Uint32Array(await (await get(`scene-thumbnail/${index}`)).arrayBuffer());
    link.append(Object.assign(imageOf(pixels.subarray(2), pixels[0]), {ariaHidden: 'true'}));
  } catch (error) {
    link.append(make('small', {}, error.message));  // why it can't be played
  }
}

function mark() {
  for (const link of list.querySelectorAll('a'))
    if (link.href === location.href) link.setAttribute('aria-current', 'true');
    else link.removeAttribute('aria-current');
}

async function show() {
  const {scenes, devices, reason} = await (await get('scenes')).json();
  const seen = new IntersectionObserver((entries) => {
    for (const {isIntersecting, target} of entries)
      if (isIntersecting) {
        seen.unobserve(target);
        addPicture(target, target.dataset.index);
      }
  });
  list.replaceChildren(...scenes.map((row) => {
    if (row.reason !== undefined) return make('li', {}, make('p', {}, `${row.name} can't be played: ${row.reason}`));
    const link = make('a', {className: 'texture', href: `scene.html#${row.index}`}, row.name, make('small', {}, contents(row)));
    link.dataset.index = row.index;
    seen.observe(link);
    return make('li', {}, link);
  }));
  count.textContent = reason !== undefined ? `The folder can't be read: ${reason}`
      : scenes.length > 0 ? plural(scenes.length, 'scene')
      : 'This folder has no force scenes (NAME.scene.json with patches or pieces).';
  mark();
  return devices;
}

addEventListener('hashchange', mark);
/** The devices of the folder: {index, name, reason if one can't be read}. */
export const folderDevices = show().catch((error) => {
  count.textContent = error.message;
  return [];
});
