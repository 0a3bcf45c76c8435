// SPDX-License-Identifier: GPL-3.0-or-later
// Records from the page of the device: begins, marks and ends a recording, and shows what it gets.

import {errorText} from './answers.js';
import {Trace} from './strip.js';

const RECONNECT_MS = 1000;
const SILENT_S = 1;      // without a frame, or without a change of a channel that is not a position
const CELLS = 100;       // of 0.1 s
const at = (id) => document.getElementById(id);
const trace = new Trace(at('record-trace'), CELLS);
let socket = null, channel = null;

const seconds = (value) => `${value.toFixed(1)} s`;
const put = (id, text) => { if (at(id).textContent !== text) at(id).textContent = text; };

/** What is silent of a recording, in words; empty if nothing is. */
export function silentWords({state, late_s, channels = []}) {
  if (state !== 'idle' && late_s >= SILENT_S) return `No frame has come for ${Math.floor(late_s)} s: is the device still connected?`;
  const silent = channels.filter(({quantity, unchanged_s}) => quantity !== 'position' && unchanged_s >= SILENT_S);
  return silent.map(({name, unchanged_s}) => `${name} has not changed for ${Math.floor(unchanged_s)} s: is its sensor connected?`).join(' ');
}

function connect() {
  socket = new WebSocket(`ws://${location.host}/recorder`);
  socket.onmessage = (event) => hear(JSON.parse(event.data));
  socket.onclose = () => {
    put('record-words', 'tactograph live does not answer');
    setTimeout(connect, RECONNECT_MS);
  };
}

function hear(message) {
  if (message.error) put('record-problem', errorText(message.error));
  if (message.event === 'failed') put('record-problem', `Not recorded: ${errorText(message)}`);
  if (message.event === 'mark') put('record-said', `mark “${message.label}” at ${seconds(message.time_s)}`);
  if (message.event === 'recorded') hearRecorded(message);
  if (message.event === 'recording') show(message);
}

function hearRecorded({name, duration_s, strokes, lost_frames, gaps, marks, ended, warnings = []}) {
  put('record-said', `Recorded: ${name}.wav and .json, ${seconds(duration_s)}, ${strokes} strokes, ${gaps} gaps (${lost_frames} frames lost), ${marks} marks.` +
    ` Next: tactograph spatial ${name} -o ${name}`);
  put('record-problem', [...(ended ? [`It ended early: ${ended}.`] : []), ...warnings].join(' '));
}

function show(recording) {
  const {state, name, device, late_s, time_s, strokes, lost_frames, speed_mps, channels = []} = recording, idle = state === 'idle';
  at('record-begin').disabled = at('record-name').disabled = !idle;
  at('record-mark').disabled = at('record-end').disabled = idle;
  put('record-words', idle ? `Records from the device “${device}” (option --device).` : state === 'opening' ? `${name}: opening ${device} …`
      : `${name}: ${seconds(time_s)}, ${strokes} strokes, ${lost_frames} frames lost, ${(recording.disk_left_bytes / 1e9).toFixed(1)} GB free` +
        (speed_mps === undefined ? '' : `, ${(1e3 * speed_mps).toFixed(0)} mm/s`));
  if (idle) return;
  const silent = silentWords(recording);
  if (silent !== '' || at('record-problem').dataset.silent) put('record-problem', silent);
  at('record-problem').dataset.silent = silent === '' ? '' : 'yes';
  showChannels(channels, late_s);
  showForce(channels);
}

function showChannels(channels, late_s) {
  const cells = channels.map(({name, unit, smallest, largest, clipped, unchanged_s}) =>
    [name, `${smallest.toPrecision(3)} to ${largest.toPrecision(3)} ${unit}${clipped ? ', clipped' : ''}`, `${seconds(late_s)} ago`, `${seconds(late_s + unchanged_s)} ago`]);
  const rows = [['Channel', 'Last 0.1 s', 'Last sample', 'Last change'], ...cells].map((texts, i) => {
    const row = document.createElement('tr');
    row.append(...texts.map((text, k) => Object.assign(document.createElement(i === 0 || k === 0 ? 'th' : 'td'), {textContent: text})));
    return row;
  });
  at('record-channels').replaceChildren(...rows);
}

// The first channel with a force, if there is one.
function showForce(channels) {
  const force = channels.find(({quantity}) => quantity.includes('force'));
  at('record-trace').hidden = at('record-force').hidden = force === undefined;
  if (force === undefined) return;
  if (channel !== force.name) trace.clear(1e-9);
  channel = force.name;
  trace.add([force.smallest, force.largest]);
  trace.full_m = Math.max(trace.peak() * 1.1, 1e-9);  // its edges, here in the channel's unit
  trace.draw();
  put('record-force', `${channel}: ${force.smallest.toPrecision(3)} to ${force.largest.toPrecision(3)} ${force.unit}; edges ±${trace.full_m.toPrecision(3)} ${force.unit}, last ${CELLS / 10} s`);
}

function ask(line) {
  put('record-problem', '');
  socket.send(line);
}
at('record-begin').addEventListener('click', () => {
  put('record-said', '');
  trace.clear(1e-9);
  ask(`record ${at('record-name').value.trim() || 'recording'}`);
});
at('record-mark').addEventListener('click', () => ask(`mark ${at('record-label').value.trim() || 'mark'}`));
at('record-end').addEventListener('click', () => ask('stop'));
connect();
