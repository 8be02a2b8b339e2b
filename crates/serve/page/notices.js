// Messages over the image: connection, steering, errors of the scene, probe, help.

import { GROUPS, helpOf } from "./keys.js";

const TOAST_MILLISECONDS = 3500;
const byId = (id) => document.getElementById(id);

export function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

let toastTimer = null;

/// Shows a sentence for some seconds.
export function toast(text) {
  const toast = byId("toast");
  toast.textContent = text;
  toast.hidden = false;
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => (toast.hidden = true), TOAST_MILLISECONDS);
}

let countdown = null;

/// Shows that the connection is lost: `milliseconds` until the next attempt, and the server's
/// reason if known. `null` hides the message.
export function connectionLost(milliseconds, why = "") {
  clearInterval(countdown);
  const notice = byId("connection");
  notice.hidden = milliseconds === null;
  if (milliseconds === null) return;
  const until = performance.now() + milliseconds;
  const say = () => {
    const seconds = Math.max(0, Math.ceil((until - performance.now()) / 1000));
    const next = seconds > 0 ? `trying again in ${seconds} s` : "trying again";
    const reason = why.includes("token") ? "the server has a new token: open the address that it printed" : why;
    notice.textContent = reason ? `Refused: ${reason} (${next})` : `Connection lost, ${next}`;
  };
  say();
  countdown = setInterval(say, 500);
}

/// Shows which page steers, unless it is this one.
export function wheel({ steering, free, watching }) {
  byId("watching").hidden = steering;
  const others = watching > 2 ? ` ${watching} pages are open.` : "";
  byId("watching-text").textContent = free ? "No page controls the session." : `Another page controls the session; this one watches.${others}`;
}

/// Shows errors of the scene; `null` hides them.
export function sceneError(text) {
  byId("error").hidden = !text;
  if (text && byId("error-text").textContent !== text) {
    byId("error-text").textContent = text;
    byId("error").classList.remove("folded");
  }
}

/// Shows a ring at a clicked point.
export function mark(x, y) {
  const mark = byId("mark");
  const again = mark.cloneNode();
  mark.replaceWith(again);
  const { left, top } = again.parentElement.getBoundingClientRect();
  again.style.left = `${x - left}px`;
  again.style.top = `${y - top}px`;
  again.hidden = false;
}

const number = (value) => (Math.abs(value) >= 1e4 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : Number(value.toPrecision(4)).toString());
const triple = (values) => values.map(number).join(", ");

/// Shows the data of a pixel; `null` hides them.
export function probe(facts) {
  const box = byId("probe");
  box.hidden = !facts;
  if (!facts) return;
  const rows = [
    ["pixel", facts.pixel.join(", ")],
    ["color", facts.color && triple(facts.color)],
    ["samples", facts.samples],
    ["noise", facts.noise != null && `${(facts.noise * 100).toFixed(2)} %`],
    ["depth", facts.depth != null && number(facts.depth)],
    ["position", facts.position && triple(facts.position)],
    ["normal", facts.normal && triple(facts.normal)],
    ["object", facts.object != null && `${facts.object}`],
    ["shape", facts.shape],
    ["material", facts.material],
  ];
  const list = element("dl");
  for (const [name, value] of rows) {
    if (value === null || value === undefined || value === false || value === "") continue;
    const shown = element("dd", {}, `${value}`);
    if (name === "color") {
      const swatch = element("span", { className: "swatch" });
      const level = (light) => Math.round(255 * Math.min(1, Math.max(0, light)) ** (1 / 2.2));
      swatch.style.background = `rgb(${facts.color.map(level).join(" ")})`;
      shown.prepend(swatch);
    }
    list.append(element("dt", {}, name), shown);
  }
  box.replaceChildren(list);
}

/// Fills the help dialog from the table of keys.
export function fillHelp() {
  const sections = GROUPS.map((group) => {
    const { gestures, keys } = helpOf(group);
    const list = element("dl");
    for (const [gesture, help] of gestures) list.append(element("dt", {}, gesture), element("dd", {}, help));
    for (const [caps, help] of keys) {
      const shown = caps.flatMap((cap) => [element("kbd", {}, cap), " "]);
      list.append(element("dt", {}, ...shown), element("dd", {}, help));
    }
    return element("section", {}, element("h3", {}, group.name), list);
  });
  byId("help-body").replaceChildren(...sections);
}
