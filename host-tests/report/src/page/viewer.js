// The viewer of every plot: a cursor with the values beneath it, and zoom. It reads the curves off the drawing, so that
// the page is whole without it.
"use strict";
for (const group of document.querySelectorAll("svg g.plot")) {
  const svg = group.ownerSVGElement, box = svg.parentElement, make = (name) => document.createElementNS(svg.namespaceURI, name);
  const [left, top, right, bottom] = JSON.parse(group.dataset.frame);
  const axis = (text, from, to) => {
    const [low, high, logarithmic] = JSON.parse(text), share = (high - low) / (to - from);
    const value = (place) => { const at = low + (place - from) * share; return logarithmic ? 10 ** at : at; };
    return { value, logarithmic };
  };
  const x = axis(group.dataset.x, left, right), y = axis(group.dataset.y, bottom, top);
  // points of a path: absolute starts, and relative steps in tenths or absolute ones
  const points = (path) => {
    const tenth = path.hasAttribute("transform") ? 0.1 : 1, found = [];
    let at = [0, 0];
    for (const [, kind, a, b] of path.getAttribute("d").matchAll(/([MLl])(-?[\d.]+) (-?[\d.]+)/g)) {
      at = kind === "l" ? [at[0] + +a * tenth, at[1] + +b * tenth] : [+a * tenth, +b * tenth];
      found.push([...at, kind === "M"]);
    }
    return found;
  };
  const names = box.closest("section")?.querySelectorAll(".legend > span") ?? [];
  const named = (wanted) => [...names].find((span) => wanted.every((one) => span.querySelector("path").classList.contains(one)))?.textContent;
  const curves = [...group.querySelectorAll("path.curve,path.truth,path.estimate")].map((path) => {
    const wanted = [...path.classList];
    const found = points(path), turns = found.some((point, k) => k > 0 && !point[2] && point[0] < found[k - 1][0]);
    return { name: named(wanted.filter((one) => one !== "curve")) ?? "", points: found, turns };
  });
  // single points, each with its name
  const marks = [...group.querySelectorAll("path.point")].map((path) => ({
    at: path.getAttribute("transform").match(/-?[\d.]+/g).map(Number), name: path.textContent,
  }));
  if (!curves.some((curve) => curve.points.length > 1) && marks.length < 2) continue;

  const at = (event) => {
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [place.x, place.y];
  };
  const isIn = ([px, py]) => px >= left && px <= right && py >= top && py <= bottom;
  // shown = scale * place + move, by which the curves are drawn
  let shown = [1, 0, 1, 0];
  const back = ([px, py]) => [(px - shown[1]) / shown[0], (py - shown[3]) / shown[2]];
  const number = (value) => value === 0 ? "0" : Math.abs(value) >= 1e6 || Math.abs(value) < 1e-4 ? value.toExponential(3) : String(+value.toPrecision(4));

  const outer = make("g"), cursor = make("line"), chosen = make("rect");
  const corners = [[left, top], [right, top], [right, bottom], [left, bottom]].map((corner) => `${corner[0]}px ${corner[1]}px`);
  outer.style.clipPath = `polygon(${corners}) view-box`;
  group.replaceWith(outer);
  outer.append(group, chosen, cursor);
  // marks beside the plot stay where they are: in a zoomed one others take their place
  for (const mark of svg.querySelectorAll(":scope > line.mark")) {
    if (mark.getAttribute("x1") !== mark.getAttribute("x2")) continue;
    const line = mark.cloneNode();
    line.classList.add("moved");
    group.append(line);
  }
  cursor.classList.add("edge");
  chosen.classList.add("band");
  const values = document.createElement("output");
  values.className = "values";
  (box.closest("figure") ?? box).append(values);

  const text = [...svg.querySelectorAll("g.axes")].find((one) => one.querySelector("line") && +one.querySelector("line").getAttribute("y2") === bottom);
  const drawn = text?.cloneNode(true);
  const ticks = () => {
    if (!text) return;
    text.replaceChildren(...drawn.cloneNode(true).childNodes);
    if (shown[0] === 1 && shown[2] === 1) return;
    text.replaceChildren();
    for (const [flat, from, to, count] of [[true, left, right, 8], [false, bottom, top, 5]]) {
      for (let k = 0; k <= count; k++) {
        const place = from + (to - from) * k / count, [px, py] = back([place, place]), line = make("line"), label = make("text");
        const ends = flat ? [place, top, place, bottom] : [left, place, right, place];
        ["x1", "y1", "x2", "y2"].forEach((key, n) => line.setAttribute(key, ends[n]));
        line.classList.add("grid");
        label.classList.add("tick");
        label.setAttribute("x", flat ? place : left - 8);
        label.setAttribute("y", flat ? bottom + 17 : place + 4);
        label.setAttribute("text-anchor", flat ? "middle" : "end");
        label.textContent = number(flat ? x.value(px) : y.value(py));
        text.append(line, label);
      }
    }
  };
  const show = (next) => {
    shown = next;
    group.setAttribute("transform", `matrix(${shown[0]} 0 0 ${shown[2]} ${shown[1]} ${shown[3]})`);
    group.classList.toggle("zoomed", shown[0] !== 1 || shown[2] !== 1);
    svg.classList.toggle("beside", svg.querySelector(".zoomed") !== null);
    // a marker keeps its shape
    for (const mark of group.querySelectorAll("path.point")) {
      mark.setAttribute("transform", mark.getAttribute("transform").replace(/ scale.*|$/, ` scale(${1 / shown[0]} ${1 / shown[2]})`));
    }
    ticks();
  };
  // of each curve the point beneath the cursor; of one that turns back the nearest
  const read = (place) => {
    const [px, py] = back(place), found = [];
    for (const { name, points, turns } of curves) {
      let best = null, least = Infinity;
      points.forEach((point, k) => {
        const before = points[k - 1];
        if (!turns && before && !point[2] && before[0] <= px && px <= point[0]) {
          const share = point[0] > before[0] ? (px - before[0]) / (point[0] - before[0]) : 0;
          [best, least] = [[px, before[1] + share * (point[1] - before[1])], 0];
        }
        const far = turns ? Math.hypot(point[0] - px, point[1] - py) : Math.abs(point[0] - px);
        if (far < least) [best, least] = [point, far];
      });
      if (best) found.push(`${name ? name + ": " : ""}${turns ? number(x.value(best[0])) + ", " : ""}${number(y.value(best[1]))}`);
    }
    const far = (mark) => Math.hypot(mark.at[0] - px, mark.at[1] - py);
    const nearest = marks.reduce((best, mark) => !best || far(mark) < far(best) ? mark : best, null);
    if (nearest && (!curves.length || far(nearest) < 12)) {
      found.unshift(`${nearest.name}: ${number(x.value(nearest.at[0]))}, ${number(y.value(nearest.at[1]))}`);
    }
    values.textContent = `${number(x.value(px))} | ${found.join(" | ")}`;
  };
  let from = null;
  svg.addEventListener("pointerdown", (event) => {
    from = isIn(at(event)) && event.button === 0 ? at(event) : null;
    if (from) event.preventDefault();
  });
  svg.addEventListener("pointermove", (event) => {
    const place = at(event);
    if (!isIn(place)) return;
    ["x1", "x2"].forEach((key) => cursor.setAttribute(key, place[0]));
    cursor.setAttribute("y1", top);
    cursor.setAttribute("y2", bottom);
    read(place);
    if (!from) return;
    for (const [key, value] of [["x", Math.min(from[0], place[0])], ["y", top], ["width", Math.abs(place[0] - from[0])], ["height", bottom - top]]) chosen.setAttribute(key, value);
  });
  svg.addEventListener("pointerup", (event) => {
    const to = at(event), begun = from;
    from = null;
    chosen.setAttribute("width", 0);
    if (!begun || Math.abs(to[0] - begun[0]) < 8) return;
    const [low, high] = [back(begun)[0], back(to)[0]].sort((a, b) => a - b), scale = (right - left) / (high - low);
    // the values in this part fill the plot
    const all = [...curves.flatMap((curve) => curve.points), ...marks.map((mark) => mark.at)];
    const seen = all.filter((point) => point[0] >= low && point[0] <= high).map((point) => point[1]);
    const [least, most] = [Math.min(...seen), Math.max(...seen)];
    let [rise, middle] = [0.9 * (bottom - top) / Math.max(most - least, 0.2), (least + most) / 2];
    // a plane keeps its circles round
    if (!seen.length || curves.some((curve) => curve.turns)) [rise, middle] = [scale, (back(begun)[1] + back(to)[1]) / 2];
    show([scale, left - scale * low, rise, (top + bottom) / 2 - rise * middle]);
  });
  svg.addEventListener("dblclick", (event) => { if (isIn(at(event))) show([1, 0, 1, 0]); });
}
