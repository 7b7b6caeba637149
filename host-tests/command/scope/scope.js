"use strict";
// The page asks for what it shows, ten times a second: the window's least and most in as many places as it has pixels.
// It keeps nothing else, so it does not grow with the run.

const byId = (id) => document.getElementById(id);
// told apart by colour-blind readers, too [Okabe, Ito 2008]
const COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D31"];
const PERIOD = 100, TRAIL = 100;

let asked = "", state = null, plots = [], names = "", view = null, armed = null, trail = [], spectrum = null;

const get = async (path) => {
  const answer = await fetch(path);
  const body = await answer.json();
  if (!answer.ok) throw new Error(body.error);
  return body;
};

const scale = () => (state && state.rate_hz ? 1 / state.rate_hz : 1);
const digits = (value) => {
  if (value === null || value === undefined) return "";
  const size = Math.abs(value);
  return size >= 1e5 && size < 1e15 ? Math.round(value).toString() : Number(value).toPrecision(5);
};
const label = (channel) => (channel.unit ? `${channel.name} (${channel.unit})` : channel.name);

function element(kind, text, parent) {
  const made = document.createElement(kind);
  made.textContent = text;
  if (parent) parent.append(made);
  return made;
}

// one plot for each unit, in the order of the channels
function build() {
  plots.forEach((plot) => plot.chart.destroy());
  byId("plots").replaceChildren();
  const groups = new Map();
  state.channels.forEach((channel, index) => {
    const key = channel.unit || channel.name;
    groups.set(key, [...(groups.get(key) || []), index]);
  });
  const axis = state.rate_hz ? "s" : "records";
  document.querySelectorAll(".axis").forEach((place) => (place.textContent = axis));
  plots = [...groups].map(([unit, channels]) => {
    const figure = element("figure", "", byId("plots"));
    figure.setAttribute("role", "img");
    figure.setAttribute("aria-label", channels.map((c) => state.channels[c].name).join(", ") + " over time");
    const series = [{ label: axis, value: (_, x) => (x === null ? "" : x.toFixed(state.rate_hz ? 4 : 0)) }];
    const bands = [];
    channels.forEach((c, n) => {
      const colour = COLOURS[c % COLOURS.length];
      const one = { stroke: colour, width: 1, points: { show: false }, value: (_, y) => digits(y) };
      series.push({ ...one, label: state.channels[c].name }, { ...one, label: `${state.channels[c].name}, least` });
      bands.push({ series: [2 * n + 1, 2 * n + 2], fill: colour + "55" });
    });
    const options = {
      width: figure.clientWidth || 600, height: 220, series, bands, scales: { x: { time: false } },
      axes: [{ label: axis }, { label: unit, size: 70 }], legend: { live: true },
      cursor: { sync: { key: "scope" }, drag: { setScale: false } },
      hooks: {
        setSelect: [(chart) => {
          if (chart.select.width < 3) return;
          const at = (x) => Math.round(chart.posToVal(x, "x") / scale());
          follow({ from: Math.max(0, at(chart.select.left)), to: at(chart.select.left + chart.select.width) });
          chart.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
        }],
        ready: [(chart) => chart.over.addEventListener("dblclick", () => follow(null))],
      },
    };
    return { chart: new uPlot(options, [[], ...series.slice(1).map(() => [])], figure), channels, figure };
  });
  for (const id of ["trigger-channel", "order-channel"]) {
    const select = byId(id);
    select.replaceChildren();
    state.channels.forEach((channel, index) => (element("option", label(channel), select).value = index));
  }
  const find = (test) => Math.max(0, state.channels.findIndex(test));
  byId("trigger-channel").value = find((channel) => channel.name === "faults");
  byId("order-channel").value = find((channel) => channel.name === "motor speed");
  const rows = byId("values").tBodies[0];
  rows.replaceChildren();
  state.channels.forEach((channel) => {
    const row = element("tr", "", rows);
    [channel.name, channel.unit, "", "", ""].forEach((text) => element("td", text, row));
  });
  trail = [];
  follow(null);
  disarm("");
}

// a fixed window, or null to follow the drive
function follow(window) {
  view = window;
  byId("hold").textContent = view ? "Run" : "Pause";
}

function shown() {
  if (view) return view;
  const [first, last] = state.ends;
  const span = Math.max(1, Math.round((Number(byId("span").value) || 1) / scale()));
  return { from: Math.max(first, last - span), to: last };
}

function tell() {
  const part = (count, word) => (count ? `, ${count} ${word}` : "");
  byId("source").textContent = state.source;
  byId("state").textContent = `${state.records} records` + part(state.dropped, "dropped by the drive") +
    part(state.missing, "ticks missing") + part(state.damaged, "frames damaged") +
    part(state.restarts, "restarts of the drive") + (state.ended ? `; ended: ${state.ended}` : "");
}

function draw(window) {
  const x = window.ticks.map((tick) => tick * scale());
  for (const plot of plots) {
    const data = [x];
    for (const c of plot.channels) data.push(window.most[c], window.least[c]);
    plot.chart.setData(data);
  }
  const range = (values, pick) => values.reduce((of, value) => (value === null ? of : of === null ? value : pick(of, value)), null);
  [...byId("values").tBodies[0].rows].forEach((row, c) => {
    const now = state.last ? state.last[c] : null;
    const texts = [now, range(window.least[c], Math.min), range(window.most[c], Math.max)].map(digits);
    texts.forEach((text, n) => (row.cells[n + 2].textContent = text));
  });
}

// room for a plot of orders, whatever stands on the page by now
const orderWidth = () => Math.max(200, Math.min(600, document.documentElement.clientWidth - 32));

function drawOrders(orders, channel) {
  const x = orders.map((one) => one.order), y = orders.map((one) => one.amplitude);
  const unit = channel.unit || channel.name;
  if (!spectrum || spectrum.unit !== unit) {
    if (spectrum) spectrum.chart.destroy();
    const options = {
      width: orderWidth(), height: 260, scales: { x: { time: false } },
      axes: [{ label: "order (times a turn)" }, { label: `amplitude (${unit})`, size: 70 }],
      series: [{ label: "order" }, { label: "amplitude", stroke: COLOURS[0], fill: COLOURS[0] + "88",
        paths: uPlot.paths.bars({ size: [0.6, 40] }), points: { show: false }, value: (_, v) => digits(v) }],
    };
    spectrum = { unit, chart: new uPlot(options, [x, y], byId("spectrum")) };
  }
  spectrum.chart.setData([x, y]);
  const first = orders.find((one) => one.order === 1);
  trail = [...trail, first].slice(-TRAIL);
  const text = `once a turn: ${digits(first.amplitude)} ${channel.unit} at ${(first.phase * 180 / Math.PI).toFixed(1)}° behind the angle's zero`;
  byId("order-state").textContent = text;
  const canvas = byId("polar"), pen = canvas.getContext("2d"), middle = canvas.width / 2, radius = middle - 36;
  canvas.setAttribute("aria-label", text);
  const most = Math.max(...trail.map((one) => one.amplitude), Number.MIN_VALUE);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.strokeStyle = "#bbb"; pen.fillStyle = "#333"; pen.font = "12px sans-serif"; pen.textAlign = "center";
  for (const part of [0.5, 1]) { pen.beginPath(); pen.arc(middle, middle, radius * part, 0, 2 * Math.PI); pen.stroke(); }
  for (const degrees of [0, 90, 180, 270]) {
    const a = degrees * Math.PI / 180;
    pen.fillText(`${degrees}°`, middle + (radius + 18) * Math.cos(a), middle - (radius + 16) * Math.sin(a) + 4);
  }
  pen.fillText(digits(most), middle + radius * 0.7, middle - 4);
  trail.forEach((one, n) => {
    pen.fillStyle = n === trail.length - 1 ? COLOURS[1] : COLOURS[0] + "66";
    const r = radius * one.amplitude / most;
    pen.beginPath(); pen.arc(middle + r * Math.cos(one.phase), middle - r * Math.sin(one.phase), n === trail.length - 1 ? 5 : 2, 0, 2 * Math.PI); pen.fill();
  });
}

async function turn() {
  state = await get("/state");
  tell();
  if (!state.ends) return;
  const now = JSON.stringify(state.channels) + state.rate_hz;
  if (now !== names) { names = now; build(); }
  if (armed !== null) {
    const { tick } = await get(`/rise?channel=${byId("trigger-channel").value}&above=${Number(byId("level").value)}&after=${armed}`);
    if (tick !== null) {
      const span = Math.max(1, Math.round((Number(byId("span").value) || 1) / scale()));
      // a fifth of the window before the trigger; what comes after it is drawn as it comes
      follow({ from: Math.max(0, tick - Math.round(span / 5)), to: tick + Math.round(4 * span / 5) });
      disarm(`triggered at ${digits(tick * scale())}`);
    }
  }
  const { from, to } = shown();
  const places = Math.min(2000, Math.max(100, document.body.clientWidth));
  draw(await get(`/window?from=${from}&to=${to}&places=${places}`));
  const channel = Number(byId("order-channel").value);
  // orders of the same window are the same
  const now_asked = [from, to, channel, state.records].slice(0, view ? 3 : 4).join();
  if (now_asked === asked) return;
  asked = now_asked;
  try {
    const { orders } = await get(`/orders?from=${from}&to=${to}&channel=${channel}`);
    if (orders) drawOrders(orders, state.channels[channel]);
    else byId("order-state").textContent = "less than a turn in the window";
  } catch (error) { byId("order-state").textContent = error.message; }
}

function disarm(text) {
  armed = null;
  byId("arm").textContent = text ? `Arm again (${text})` : "Arm";
}

byId("hold").addEventListener("click", () => { if (state && state.ends) follow(view ? null : shown()); });
byId("arm").addEventListener("click", () => {
  if (armed !== null) return disarm("");
  if (state && state.ends) { armed = state.ends[1]; follow(null); byId("arm").textContent = "Disarm"; }
});
byId("save").addEventListener("click", async () => {
  if (!state || !state.ends) return;
  const { from, to } = shown();
  const answer = await fetch(`/csv?from=${from}&to=${to}`);
  byId("saved").textContent = answer.ok ? "" : (await answer.json()).error;
  if (!answer.ok) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await answer.blob());
  link.download = "scope.csv";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
});
byId("order-channel").addEventListener("change", () => { trail = []; asked = ""; });
byId("controls").addEventListener("submit", (event) => event.preventDefault());
window.addEventListener("resize", () => {
  plots.forEach(({ chart, figure }) => chart.setSize({ width: figure.clientWidth, height: 220 }));
  if (spectrum) spectrum.chart.setSize({ width: orderWidth(), height: 260 });
});

async function loop() {
  try {
    await turn();
    byId("state").classList.remove("failed");
  } catch (error) {
    byId("state").textContent = `the scope does not answer: ${error.message}`;
    byId("state").classList.add("failed");
  }
  setTimeout(loop, PERIOD);
}
loop();
