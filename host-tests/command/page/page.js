// The page of the design: a file as text, its numbers as sliders, and the answer of the commands' own functions.
"use strict";
const $ = (id) => document.getElementById(id);
const examples = JSON.parse($("examples").textContent);
const packed = Uint8Array.from(atob($("core").textContent), (letter) => letter.charCodeAt(0));
const compiled = new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip")))
  .arrayBuffer().then((bytes) => WebAssembly.compile(bytes));
let core = compiled.then((module) => WebAssembly.instantiate(module, {}));

// The answer to a request: {json, page, machine, rust, error}.
const ask = async (request) => {
  const { memory, room, answer, answered } = (await core).exports;
  try {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    // may replace the buffer
    const at = room(bytes.length) >>> 0;
    new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
    const length = answer() >>> 0;
    return JSON.parse(new TextDecoder().decode(new Uint8Array(memory.buffer, answered() >>> 0, length)));
  } catch (error) {
    core = compiled.then((module) => WebAssembly.instantiate(module, {}));
    return { error: `The calculation has stopped (${error.message}). The values before it still stand.` };
  }
};

let name = "machine.toml", last = {}, viewer = "";
const kind = (text) => /^\s*\[\[element\]\]/m.test(text) ? "design" : "balancing";

const show = (answer, what, took) => {
  $("error").hidden = !answer.error;
  $("error").textContent = answer.error ?? "";
  $("said").textContent = answer.error ? "" : `${what}: ${took.toFixed(0)} ms`;
  if (!answer.page) return;
  const page = new DOMParser().parseFromString(answer.page, "text/html");
  if (!viewer) {
    viewer = page.querySelector("script").textContent;
    document.head.prepend(page.querySelector("style"));
  }
  const height = $("result").offsetHeight;
  $("result").style.minHeight = `${height}px`;
  $("result").replaceChildren(...page.querySelector("main").childNodes);
  const script = document.createElement("script");
  script.textContent = viewer;
  $("result").append(script);
  $("result").style.minHeight = "";
};

// what is to be answered next: with fewer points while a slider moves, and in full once it rests
let busy = false, next = null, rest = 0;
const answerText = async (quick = false) => {
  next = { quick };
  if (busy) return;
  busy = true;
  while (next) {
    const { quick } = next, text = $("text").value, begin = performance.now();
    next = null;
    const answer = await ask({ do: kind(text), name, text, quick });
    if (!answer.error) last = answer;
    show(answer, kind(text), performance.now() - begin);
    document.documentElement.dataset.took = performance.now() - begin;
    // the page is drawn before the next value
    if (next) await new Promise((done) => setTimeout(done));
  }
  busy = false;
  $("rust").disabled = !last.rust || kind($("text").value) !== "design";
  const to = kind($("text").value) === "design" ? `cargo driveline campaign ${name}` : "";
  $("command").textContent = [`cargo driveline ${kind($("text").value)} ${name}`, to].filter(Boolean).join("; ");
};

// A slider for each number of the machine: a quarter to four times what the file has.
const knobs = () => {
  const rows = [];
  let of = "";
  $("text").value.split("\n").forEach((line, at) => {
    const table = line.match(/^\s*\[+([\w.]+)\]+/), word = line.match(/^\s*(kind|label)\s*=\s*"([^"]*)"/);
    if (table) of = table[1];
    if (word) of = word[2];
    const number = line.match(/^(\s*(\w+)\s*=\s*)(-?[\d_.]+(?:[eE][-+]?\d+)?)(\s*(?:#.*)?)$/);
    if (!number || +number[3] === 0 || kind($("text").value) !== "design") return;
    const row = document.createElement("div"), title = document.createElement("span");
    const slider = document.createElement("input"), value = document.createElement("input");
    const start = Number(number[3].replaceAll("_", "")), whole = /^-?[\d_]+$/.test(number[3]), id = `${of}: ${number[2]}`;
    title.textContent = id;
    title.title = number[4].replace(/^\s*#\s*/, "");
    Object.assign(slider, { type: "range", min: -1, max: 1, step: 0.01, value: 0 });
    Object.assign(value, { type: "number", step: "any", value: start });
    slider.setAttribute("aria-label", id);
    value.setAttribute("aria-label", `${id}, value`);
    const put = (next) => {
      const lines = $("text").value.split("\n");
      const shown = whole ? String(Math.max(1, Math.round(next))) : String(+next.toPrecision(4));
      lines[at] = `${number[1]}${whole || /[.e]/.test(shown) ? shown : shown + ".0"}${number[4]}`;
      $("text").value = lines.join("\n");
      return shown;
    };
    slider.addEventListener("input", () => {
      value.value = put(start * 4 ** slider.value);
      answerText(true);
      clearTimeout(rest);
      rest = setTimeout(answerText, 250);
    });
    value.addEventListener("change", () => { if (value.value !== "") { put(+value.value); answerText(); } });
    row.className = "knob";
    row.append(title, slider, value);
    rows.push(row);
  });
  $("knobs").replaceChildren(...rows);
};

const put = (file, text) => {
  [name, $("text").value] = [file, text];
  knobs();
  return answerText();
};
const take = async (file) => {
  const text = await file.text();
  if (!/\.(csv|txt)$/i.test(file.name)) return put(file.name, text);
  const value = (id) => $(id).value === "" ? null : +$(id).value, begin = performance.now();
  const answer = await ask({
    do: "identify", name: file.name, text, rate: value("rate"), torque_constant: value("constant"), window: [null, value("to")],
  });
  if (answer.machine) {
    name = file.name.replace(/\.\w+$/, ".toml");
    $("text").value = answer.machine;
    knobs();
    const options = [["rate", "rate"], ["torque-constant", "constant"], ["to", "to"]].filter(([, id]) => $(id).value !== "");
    const line = options.map(([option, id]) => ` --${option} ${$(id).value}`).join("");
    $("command").textContent = `cargo driveline identify ${file.name}${line} --toml ${name}; cargo driveline design ${name}`;
  }
  // the identification's page stays until the machine is changed
  show(answer, "identify", performance.now() - begin);
};
const save = (file, text) => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
  link.download = file;
  link.click();
  URL.revokeObjectURL(link.href);
};

$("example").append(...Object.keys(examples).map((one) => new Option(one)));
$("example").addEventListener("change", () => put(`${$("example").value}.toml`, examples[$("example").value]));
$("open").addEventListener("change", () => { if ($("open").files[0]) take($("open").files[0]); });
$("text").addEventListener("change", () => { knobs(); answerText(); });
$("text").addEventListener("input", () => answerText());
$("file").addEventListener("click", () => save(name, $("text").value));
$("rust").addEventListener("click", () => save("machine.rs", last.rust));
addEventListener("dragover", (event) => { event.preventDefault(); $("work").classList.add("over"); });
addEventListener("dragleave", () => $("work").classList.remove("over"));
addEventListener("drop", (event) => {
  event.preventDefault();
  $("work").classList.remove("over");
  if (event.dataTransfer.files[0]) take(event.dataTransfer.files[0]);
});
put("roll.toml", examples.roll);
$("example").value = "roll";
