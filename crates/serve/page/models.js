// Choices of models: material variants and animation clips. A choice is an edit of the scene.

import { element } from "./notices.js";

/// Text of the choice that selects nothing.
const NONE = { variant: "none", clip: "rest pose" };

function row(model, label, names, edit) {
  const choices = [["", NONE[label]], ...names.map((name) => [name, name])];
  const options = choices.map(([value, text]) => element("option", { value }, text));
  const control = element("select", { name: label, ariaLabel: `${label} of ${model.file}` }, ...options);
  const [path, none] = label === "clip" ? [`${model.pointer}/animation`, "none"] : [`${model.pointer}/variant`, null];
  control.onchange = ({ target }) => edit({ set: { path, value: target.value || none } });
  const title = label[0].toUpperCase() + label.slice(1);
  return element("label", { className: "row" }, element("span", {}, title), control);
}

function rows(model, edit) {
  const file = model.file.split(/[\\/]/).at(-1);
  const found = [element("p", {}, file)];
  if (model.variants.length) found.push(row(model, "variant", model.variants, edit));
  if (model.clips.length) found.push(row(model, "clip", model.clips, edit));
  return element("div", {}, ...found);
}

/// Shows the scene's models, if any has variants or clips.
export function showModels(models, edit) {
  const all = document.getElementById("model-rows");
  const key = JSON.stringify(models.map(({ pointer, file, variants, clips }) => [pointer, file, variants, clips]));
  document.getElementById("models").hidden = models.length === 0;
  if (all.dataset.models !== key) {
    all.dataset.models = key;
    all.replaceChildren(...models.map((model) => rows(model, edit)));
  }
  for (const [at, model] of models.entries()) {
    for (const control of all.children[at].querySelectorAll("select")) {
      const chosen = (control.name === "clip" ? model.clip : model.variant) ?? "";
      if (document.activeElement !== control && control.value !== chosen) control.value = chosen;
    }
  }
}
