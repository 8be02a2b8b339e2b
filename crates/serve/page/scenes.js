// Scene chooser. Its thumbnails are loaded when they come into view.

import { element } from "./notices.js";

const byId = (id) => document.getElementById(id);

/// Fills the dialog; it calls `choose(name)` with the chosen scene.
export function fillScenes(catalog, choose) {
  const card = ({ name, title, description }, picture) => {
    const button = element("button", { className: "card" }, picture, element("strong", {}, title || name), element("span", {}, description ?? ""));
    button.dataset.name = name;
    button.dataset.words = `${name} ${title} ${description}`.toLowerCase();
    button.onclick = () => {
      byId("scenes").close();
      choose(name);
    };
    return element("li", {}, button);
  };
  const own = catalog.file && card({ ...catalog.file, description: "the scene that the server was started with" }, element("span", { className: "own" }, "{ }"));
  const built = catalog.scenes.map((scene) => {
    const picture = element("img", { loading: "lazy", alt: "", width: 192, height: 120, src: `/thumbnail/${scene.name}.jpg` });
    return card(scene, picture);
  });
  byId("scene-list").replaceChildren(...(own ? [own] : []), ...built);
  byId("scene-search").oninput = ({ target }) => {
    const words = target.value.toLowerCase().split(/\s+/);
    for (const button of document.querySelectorAll(".card")) {
      button.parentElement.hidden = !words.every((word) => button.dataset.words.includes(word));
    }
  };
}

/// Opens the dialog with the current scene marked.
export function openScenes(current) {
  for (const button of document.querySelectorAll(".card")) {
    button.classList.toggle("current", button.dataset.name === current);
    button.ariaCurrent = button.dataset.name === current ? "true" : null;
  }
  byId("scenes").showModal();
  const shown = document.querySelector(".card.current");
  shown?.scrollIntoView({ block: "center" });
  // Focus a card on touch screens, since the search field would open the keyboard.
  if (matchMedia("(pointer: coarse)").matches) shown?.focus();
}
