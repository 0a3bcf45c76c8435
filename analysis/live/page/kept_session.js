// SPDX-License-Identifier: GPL-3.0-or-later
// The session of a page: its connection to the server, whether it can be kept, and the words about it.

import {errorText} from './answers.js';

export const IDLE_S = 30;       // without motion: then the drive falls and the session ends
export const LONGEST_S = 590;   // of a session; the server accepts 600
const RECONNECT_MS = 2000;

export class KeptSession {
  state = 'none';  // 'none', 'open', 'kept'

  /** `path` of the WebSocket; `words`: element of the page; `fault(text)`, with what it says of the device; `changed()` after each message. */
  constructor(path, words, fault, changed) {
    Object.assign(this, {path, words, fault, changed});
    this.connect();
  }
  connect() {
    this.socket = new WebSocket(`ws://${location.host}${this.path}`);
    this.socket.onmessage = (event) => this.hear(JSON.parse(event.data));
    this.socket.onclose = () => {
      if (this.state === 'open') this.state = 'none';
      this.words.textContent = 'The server is gone: nothing can be kept. Trying again.';
      setTimeout(() => this.connect(), RECONNECT_MS);
    };
    this.socket.onopen = () => { if (this.words.textContent.startsWith('The server is gone')) this.words.textContent = 'The server is back.'; };
  }
  send(data) { if (this.socket.readyState === WebSocket.OPEN) this.socket.send(data); }
  request(request, members = {}) { this.send(JSON.stringify({request, ...members})); }

  hear(message) {
    if (message.error) {
      this.state = 'none';
      this.words.textContent = `Not kept: ${errorText(message.error)}`;
    }
    if (message.event === 'fault') this.fault(`Fault: ${message.what}. ${message.remedy ?? ''}`);
    if (message.kept !== undefined) {
      this.state = 'kept';
      this.words.textContent = `Kept: ${message.kept}, ${message.ticks} ticks${message.lost_ticks > 0 ? `, ${message.lost_ticks} lost` : ''}. Check it: tactograph replay ${message.kept}`;
    }
    this.changed();
  }
  /** Of what the server has made for the page; `things`: textures or scenes. */
  begin(made, things) {
    this.request('begin', {made});
    this.state = this.socket.readyState === WebSocket.OPEN ? 'open' : 'none';
    if (this.state === 'open') this.words.textContent = `Keep stops and writes the session into the folder of the ${things}.`;
  }
  /** Once the last ticks are sent. */
  keep() {
    this.words.textContent = 'Keeping …';
    this.request('keep');
  }
}
