// SPDX-License-Identifier: GPL-3.0-or-later
// What the server answers, and its errors in words.

/** @param {{what: string, where?: string, remedy?: string}} error */
export const errorText = ({what, where, remedy}) => `${where ? where + ': ' : ''}${what}${remedy ? ` (${remedy})` : ''}`;

/** A file of the server; fails with the text of its error. */
export async function get(path) {
  const answer = await fetch(path);
  if (answer.ok) return answer;
  const body = await answer.text();
  let text = body;
  try { text = errorText(JSON.parse(body).error); } catch { /* no JSON: the text itself */ }
  throw new Error(text);
}
