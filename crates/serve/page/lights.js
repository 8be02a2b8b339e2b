// Light mixer: intensity and color of each light group. Changes relight the image without tracing
// it again.

import { element } from "./notices.js";

/// Maximum intensity of the slider.
const MOST = 4;

const toScreen = (light) => Math.round(255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055));
const toLight = (level) => (level / 255 <= 0.04045 ? level / 255 / 12.92 : ((level / 255 + 0.055) / 1.055) ** 2.4);

/// Splits a gain into intensity and a color whose largest channel is 1.
function parts(gain) {
  const strength = Math.max(...gain);
  const color = strength > 0 ? gain.map((factor) => factor / strength) : [1, 1, 1];
  return { strength, hex: `#${color.map((light) => toScreen(light).toString(16).padStart(2, "0")).join("")}` };
}

function row(name, edit) {
  const strength = element("input", { type: "range", min: 0, max: MOST, step: 0.01, ariaLabel: `Strength of ${name}` });
  const color = element("input", { type: "color", ariaLabel: `Color of ${name}` });
  const tell = () => {
    const lights = [1, 3, 5].map((at) => toLight(parseInt(color.value.slice(at, at + 2), 16)));
    const most = Math.max(...lights, 1e-6);
    edit({ setting: { gain: [name, lights.map((light) => (light / most) * Number(strength.value))] } });
  };
  strength.oninput = tell;
  color.oninput = tell;
  strength.ondblclick = () => edit({ setting: { gain: [name, [1, 1, 1]] } });
  const label = element("label", { className: "row" }, element("span", {}, name), strength, color, element("output", {}));
  return label;
}

/// Shows the scene's light groups, if it has any.
export function showLights(groups, edit) {
  const rows = document.getElementById("light-rows");
  const key = groups.map(([name]) => name).join("\n");
  document.getElementById("lights").hidden = groups.length === 0;
  if (rows.dataset.names !== key) {
    rows.dataset.names = key;
    rows.replaceChildren(...groups.map(([name]) => row(name, edit)));
  }
  for (const [at, [, gain]] of groups.entries()) {
    const [strength, color] = rows.children[at].querySelectorAll("input");
    const now = parts(gain);
    if (!strength.matches(":active")) strength.value = now.strength;
    if (document.activeElement !== color && now.strength > 0) color.value = now.hex;
    rows.children[at].querySelector("output").textContent = `${Number(now.strength.toFixed(2))}×`;
  }
}
