// SPDX-License-Identifier: GPL-3.0-or-later
// The page of jobs: starts verbs of the command on files of the folder, shows what they print, opens their pages.

import {errorText, get} from './answers.js';
import {make} from './library.js';

const RECONNECT_MS = 2000;
const FILES = {compare: 2, fidelity: 1, trade: 1, report: 0};  // how many each verb takes
const NEEDS_TEXTURE = ['fidelity'];
const MARKS = {waiting: '…', running: '▶', done: '✔', failed: '▲', cancelled: '■'};

const at = (id) => document.getElementById(id);
let socket = null, files = [], items = new Map();  // elements of jobs, by number

function say(text) { if (at('message').textContent !== text) at('message').textContent = text; }

function connect() {
  socket = new WebSocket(`ws://${location.host}/jobs`);
  socket.onopen = () => say('');
  socket.onmessage = (event) => hear(JSON.parse(event.data));
  socket.onclose = () => {
    say('tactograph live does not answer. Trying again.');
    setTimeout(connect, RECONNECT_MS);
  };
}

function ask(request, members) {
  say('');
  if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({request, ...members}));
  else say('tactograph live does not answer.');
}

function hear(message) {
  if (message.ok === false) say(errorText(message.error));
  if (message.event === 'jobs') show(message.jobs);
}

/** The last line of what a job has said, which is its progress while it runs. */
const lastLine = (text) => text.trimEnd().split('\n').at(-1);

function show(jobs) {
  for (const [number, item] of items)
    if (!jobs.some((job) => job.number === number)) {
      item.element.remove();
      items.delete(number);
    }
  for (const job of jobs) {
    if (!items.has(job.number)) add(job);
    update(items.get(job.number), job);
  }
  const running = jobs.find(({state}) => state === 'running'), waiting = jobs.filter(({state}) => state === 'waiting').length;
  at('now').textContent = running ? `${lastLine(running.said) || 'running'}${waiting > 0 ? `; ${waiting} more wait` : ''}`
      : jobs.length === 0 ? 'No jobs yet.' : 'No job runs.';
}

// The newest one is above. Elements stay, so that the focus and what was opened stay.
function add({number, command}) {
  const state = make('strong', {}), cancel = make('button', {type: 'button', ariaLabel: `Cancel ${command}`, onclick: () => ask('cancel', {job: number})}, 'Cancel');
  const open = make('a', {href: `result/${number}`, target: '_blank', rel: 'noopener', hidden: true});
  const said = make('pre', {}), printed = make('pre', {}), answer = make('details', {hidden: true}, make('summary', {ariaLabel: `What ${command} printed`}, 'What it printed'), printed);
  const element = make('li', {}, make('div', {className: 'row'}, state, cancel), make('code', {}, command), said, answer, open);
  items.set(number, {element, state, cancel, open, said, printed, answer});
  at('jobs').prepend(element);
}

function update(item, job) {
  const ends = job.state === 'waiting' || job.state === 'running';
  const put = (element, text) => { if (element.textContent !== text) element.textContent = text; };
  put(item.state, `${MARKS[job.state]} ${job.state === 'running' && job.cancelled ? 'is being cancelled' : job.state}`);
  item.cancel.hidden = item.cancel.disabled = !ends;
  put(item.said, job.state === 'running' ? lastLine(job.said) : job.said.trimEnd());
  put(item.printed, job.printed);
  item.answer.hidden = job.printed === '';
  item.open.hidden = job.page === undefined;
  put(item.open, job.page === undefined ? '' : `Open ${job.page}`);
}

// The choice of files.
function offer() {
  const verb = at('verb').value, count = FILES[verb];
  for (const [i, id] of ['first', 'second'].entries()) {
    const before = at(id).value, offered = files.filter(({texture}) => texture || !NEEDS_TEXTURE.includes(verb));
    at(id).replaceChildren(...offered.map(({index, words}) => new Option(words, index)));
    at(id).value = before;
    if (at(id).selectedIndex < 0) at(id).selectedIndex = Math.min(i, offered.length - 1);
    at(`${id}-label`).hidden = i >= count;
  }
  at('run').disabled = count > 0 && at('first').value === '';
}

at('verb').addEventListener('input', offer);
at('controls').addEventListener('submit', (event) => {
  event.preventDefault();
  const verb = at('verb').value;
  ask('run', {verb, files: ['first', 'second'].slice(0, FILES[verb]).map((id) => Number(at(id).value))});
});

async function begin() {
  connect();
  const {textures, recordings} = await (await get('textures')).json();
  const readable = (rows, texture, kind) => rows.filter(({reason}) => reason === undefined).map(({index, name}) => ({index, texture, words: `${name} (${kind})`}));
  files = [...readable(textures, true, 'texture'), ...readable(recordings, false, 'recording')];
  offer();
  if (location.hash.length > 1) at('first').value = location.hash.slice(1);
  offer();
}

begin().catch((error) => say(error.message));
