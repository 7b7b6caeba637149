// What a reader of the page would stumble over, as sentences. `scrolls`: whether a wide table may scroll in its card.
((scrolls) => {
  const found = new Set();
  const say = (what) => found.add(what);
  const cut = (text) => text.replace(/\s+/g, " ").trim().slice(0, 40);
  const seen = (element) => element.getClientRects().length > 0;
  const { body, documentElement: root } = document;

  // every button of a choice shows something else
  const groups = new Map();
  for (const button of body.querySelectorAll("input[type=radio]:not([hidden])")) {
    groups.set(button.name, [...(groups.get(button.name) ?? []), button]);
  }
  for (const [group, buttons] of groups) {
    const shown = buttons.map((button) => {
      button.click();
      return [...body.querySelectorAll("figure")].map((figure) => Number(seen(figure))).join("");
    });
    if (new Set(shown).size < buttons.length) say(`two buttons of "${group}" show the same`);
    buttons[0].click();
  }

  if (root.scrollWidth > root.clientWidth) say(`the page is ${root.scrollWidth} wide`);
  for (const card of body.querySelectorAll("section,header")) {
    if (card.scrollWidth > card.clientWidth) say(`wider than its card: ${cut(card.textContent)}`);
  }
  for (const part of scrolls ? [] : body.querySelectorAll(".scroll,.wide,pre")) {
    const more = part.scrollWidth - part.clientWidth;
    if (more > 0) say(`cut off by ${more}: ${cut(part.textContent)}`);
  }

  // every plot gives its values under the cursor, and a drag across it zooms until a double click
  for (const group of [...body.querySelectorAll("g.plot")].filter(seen)) {
    const svg = group.ownerSVGElement, name = svg.getAttribute("aria-label");
    const [left, top, right, bottom] = JSON.parse(group.dataset.frame), matrix = svg.getScreenCTM();
    const send = (kind, share) => {
      const { x, y } = new DOMPoint(left + share * (right - left), (top + bottom) / 2).matrixTransform(matrix);
      svg.dispatchEvent(new PointerEvent(kind, { clientX: x, clientY: y, bubbles: true }));
    };
    if (!group.querySelector("path.curve,path.truth,path.estimate") && group.querySelectorAll("path.point").length < 2) continue;
    send("pointermove", 0.4);
    const values = (svg.closest("figure") ?? svg.parentElement).querySelectorAll(".values");
    if (![...values].some((one) => /\d.*\|.*\d/.test(one.textContent))) say(`no values under the cursor: ${name}`);
    send("pointerdown", 0.3);
    send("pointermove", 0.6);
    send("pointerup", 0.6);
    const zoomed = group.getAttribute("transform") ?? "";
    if (!/^matrix\((3\.|[4-9])/.test(zoomed)) say(`a drag does not zoom (${zoomed}): ${name}`);
    send("dblclick", 0.5);
    if (group.getAttribute("transform") !== "matrix(1 0 0 1 0 0)") say(`a double click does not reset: ${name}`);
    values.forEach((one) => { one.textContent = ""; });
  }

  // a label's box without the room above and below its letters
  const box = (label) => {
    const { left, right, top, bottom } = label.getBoundingClientRect();
    const upright = bottom - top > right - left && label.hasAttribute("transform");
    const [x, y] = upright ? [(right - left) / 5, 0] : [0, (bottom - top) / 5];
    return { left: left + x, right: right - x, top: top + y, bottom: bottom - y };
  };
  for (const svg of [...body.querySelectorAll("svg")].filter(seen)) {
    const name = svg.getAttribute("aria-label");
    if (svg.getAttribute("aria-hidden") !== "true" && !name) say(`no text in place of ${cut(svg.outerHTML)}`);
    const frame = svg.getBoundingClientRect();
    const labels = [...svg.querySelectorAll("text")].filter((label) => seen(label) && label.textContent.trim());
    const boxes = labels.map(box);
    boxes.forEach((a, i) => {
      const text = cut(labels[i].textContent);
      if (a.left < frame.left - 1 || a.right > frame.right + 1 || a.top < frame.top - 1 || a.bottom > frame.bottom + 1) {
        say(`"${text}" leaves its plot: ${name}`);
      }
      boxes.slice(i + 1).forEach((b, j) => {
        const [x, y] = [Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)];
        if (x > 0.5 && y > 0.5) say(`"${text}" lies on "${cut(labels[i + 1 + j].textContent)}": ${name}`);
      });
    });
  }
  return [...found];
})
