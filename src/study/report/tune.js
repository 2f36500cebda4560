// The page of a tuning: the front, what parameters are worth, where candidates lie. D3 does scales, axes and shapes.
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = id => document.getElementById(id);
const hues = ["#5c7c8a", "#0b78c2", "#17936b", "#b4509c"], peerHue = "#a06a00", good = "#0b78c2", bad = "#d1591a";
const figure = (v, digits = 3) => v === null || v === undefined || !isFinite(v) ? "–" : Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-4) ? v.toExponential(digits - 1) : String(+v.toPrecision(digits));
const percent = v => v === null ? "–" : figure(100 * v) + " %";
const listed = settings => Object.entries(settings).map(([k, v]) => k + "=" + v).join(" ") || "as the plan decides";
const curves = data.finalists.filter(f => f.points.length > 1), peers = data.finalists.filter(f => f.points.length === 1);
const nominal = data.unit !== "seconds", tuned = data.finalists.find(f => f.name === data.chosen.name), standard = data.finalists[0];
const hueOf = f => curves.includes(f) ? hues[curves.indexOf(f) % hues.length] : peerHue;

const tip = d3.select("body").append("div").attr("class", "tip").attr("role", "status").style("display", "none");
function showTip(x, y, text) {
  tip.style("display", "block").text(text);
  const box = tip.node().getBoundingClientRect();
  tip.style("left", Math.max(4, Math.min(innerWidth - box.width - 8, x + 12)) + "px").style("top", Math.max(4, y - box.height - 10) + "px");
}
function tipFor(selection, textOf) {
  selection.attr("tabindex", 0).attr("role", "img").attr("aria-label", textOf)
    .on("mousemove", function () { showTip(d3.event.clientX, d3.event.clientY, textOf(d3.select(this).datum())); })
    .on("focus", function () { const b = this.getBoundingClientRect(); showTip(b.right, b.top, textOf(d3.select(this).datum())); })
    .on("mouseleave", () => tip.style("display", "none")).on("blur", () => tip.style("display", "none"));
}
const widthOf = id => Math.max(300, Math.min(1080, $(id).clientWidth || 1000));
function newSvg(node, width, height, label) {
  const at = typeof node === "string" ? d3.select("#" + node) : node;
  at.selectAll("svg").remove();
  return at.append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "img").attr("aria-label", label);
}
function logTicks(scale, room) {
  const [low, high] = scale.domain(), decades = Math.log10(high / low), steps = decades > room ? [1] : decades > 1.3 ? [1, 2, 5] : [1, 1.5, 2, 3, 5, 7], ticks = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); ++e) for (const s of steps) { const v = s * 10 ** e; if (v >= low * .999 && v <= high * 1.001) ticks.push(v); }
  return ticks;
}

function drawFront() {
  const width = widthOf("front"), height = Math.min(540, Math.max(340, width * .52)), box = {left: 76, right: width - 110, top: 12, bottom: height - 46};
  const all = data.finalists.flatMap(f => f.points.map(p => ({f, p}))), ys = all.flatMap(({p}) => [p.error.value, p.error.low || p.error.value, p.error.high || p.error.value]).filter(v => v > 0), xs = all.map(({p}) => p.seconds.value);
  const svg = newSvg("front", width, height, "Error against seconds for " + data.finalists.map(f => f.name).join(", ") + ". The table under Figures holds the values.");
  const x = d3.scaleLog().domain([d3.min(xs) / 1.2, d3.max(xs) * 1.2]).range([box.left, box.right]), y = d3.scaleLog().domain([d3.min(ys) / 1.15, d3.max(ys) * 1.15]).range([box.bottom, box.top]).clamp(true);
  const xTicks = logTicks(x, 2.2), yTicks = logTicks(y, 2.2);
  svg.append("g").attr("class", "grid").selectAll("line").data(yTicks).enter().append("line").attr("x1", box.left).attr("x2", box.right).attr("y1", y).attr("y2", y);
  svg.append("g").attr("class", "grid").selectAll("line").data(xTicks).enter().append("line").attr("x1", x).attr("x2", x).attr("y1", box.top).attr("y2", box.bottom);
  svg.append("g").attr("transform", `translate(0,${box.bottom})`).call(d3.axisBottom(x).tickValues(xTicks).tickFormat(v => figure(v)));
  svg.append("g").attr("transform", `translate(${box.left},0)`).call(d3.axisLeft(y).tickValues(yTicks).tickFormat(v => percent(v)));
  svg.append("text").attr("x", (box.left + box.right) / 2).attr("y", height - 6).attr("text-anchor", "middle").text(data.unit);
  svg.append("text").attr("transform", `translate(14,${(box.top + box.bottom) / 2}) rotate(-90)`).attr("text-anchor", "middle").text("error, √relMSE");
  const stair = data.front.map(p => [x(p.seconds), y(p.error.value)]);
  svg.append("path").attr("fill", "none").attr("stroke", "currentColor").attr("stroke-opacity", .35).attr("stroke-width", 8).attr("stroke-linejoin", "round").attr("d", d3.line()(stair));
  const labels = [];
  for (const f of data.finalists) {
    const group = svg.append("g").attr("class", "curve").attr("data-name", f.name), hue = hueOf(f), line = curves.includes(f);
    if (line) group.append("path").attr("fill", "none").attr("stroke", hue).attr("stroke-width", 2.4).attr("stroke-dasharray", f === standard ? "7 4" : "").attr("d", d3.line().x(p => x(p.seconds.value)).y(p => y(p.error.value))(f.points));
    group.selectAll("line").data(f.points.filter(p => p.error.low > 0 && p.error.high > 0)).enter().append("line").attr("stroke", hue).attr("x1", p => x(p.seconds.value)).attr("x2", p => x(p.seconds.value)).attr("y1", p => y(p.error.low)).attr("y2", p => y(p.error.high));
    const marks = group.selectAll("path.mark").data(f.points).enter().append("path").attr("class", "mark").attr("fill", hue).attr("stroke", p => p.on_front ? "currentColor" : "none").attr("stroke-width", 2)
      .attr("d", d3.symbol().type(line ? d3.symbols[curves.indexOf(f) % 4] : d3.symbolCross).size(90)).attr("transform", p => `translate(${x(p.seconds.value)},${y(p.error.value)})`);
    tipFor(marks, p => `${f.name}: ${listed(f.settings)}\n${figure(p.seconds.value)} ${nominal ? "nominal s" : "s"}, error ${percent(p.error.value)}\n${p.error.low === null ? "one seed: no interval" : "95 %: " + percent(p.error.low) + " to " + percent(p.error.high)}\ntime for the default's error: ${figure(p.relmse_cost_over_default.value)} of its time`);
    const last = f.points[f.points.length - 1];
    if (last) labels.push({name: f.name, hue, x: x(last.seconds.value), y: y(last.error.value)});
  }
  labels.sort((a, b) => a.y - b.y);
  for (let i = 0, top = -1e9; i < labels.length; ++i) { labels[i].at = Math.max(labels[i].y, top + 15); top = labels[i].at; }
  const over = labels.length ? Math.max(0, labels[labels.length - 1].at - box.bottom) : 0;
  for (const l of labels) {
    svg.append("line").attr("stroke", l.hue).attr("stroke-opacity", .5).attr("x1", l.x + 6).attr("y1", l.y).attr("x2", box.right + 8).attr("y2", l.at - over);
    svg.append("text").attr("x", box.right + 12).attr("y", l.at - over + 4).style("fill", l.hue).text(l.name);
  }
}

function drawWorth() {
  const rows = data.parameters.filter(p => p.worth !== undefined).sort((a, b) => b.worth - a.worth);
  if (!rows.length) { $("worth").textContent = "The default was not surely beaten: no departure from it is worth anything."; return; }
  const width = widthOf("worth"), left = Math.min(190, width * .4), height = rows.length * 30 + 40;
  const svg = newSvg("worth", width, height, rows.map(p => `${p.name}: ${figure(p.worth)}`).join("; "));
  const x = d3.scaleLog().domain([Math.min(.9, d3.min(rows, p => p.worth) / 1.05), Math.max(1.3, d3.max(rows, p => p.worth) * 1.05)]).range([left, width - 150]);
  svg.append("line").attr("stroke", "currentColor").attr("x1", x(1)).attr("x2", x(1)).attr("y1", 0).attr("y2", rows.length * 30);
  rows.forEach((p, i) => {
    const row = svg.append("g").datum(p), top = i * 30;
    row.append("text").attr("x", left - 10).attr("y", top + 19).attr("text-anchor", "end").text(p.name);
    row.append("rect").attr("x", Math.min(x(1), x(p.worth))).attr("width", Math.max(1, Math.abs(x(p.worth) - x(1)))).attr("y", top + 5).attr("height", 18).attr("fill", good).attr("fill-opacity", p.kept ? 1 : .3);
    row.append("text").attr("x", Math.max(x(1), x(p.worth)) + 8).attr("y", top + 19).text(`× ${figure(p.worth)}` + (p.kept ? `   ${figure(+p.default) === "NaN" ? p.default : p.default} → ${p.tuned}` : "   taken back"));
    tipFor(row, q => `${q.name}: ${q.help}\ndefault ${q.default}, tuned ${q.tuned}\nwithout it the time is ${figure(q.worth)} times as long`);
  });
  svg.append("g").attr("transform", `translate(0,${rows.length * 30 + 4})`).call(d3.axisBottom(x).tickValues(logTicks(x, 1.2)).tickFormat(v => "× " + figure(v)));
}

const scoreOf = c => c.relmse_cost_over_default[c.relmse_cost_over_default.length - 1];
const valueOf = (c, p) => c.settings[p.name] === undefined ? p.default : c.settings[p.name];
// Where no number stands for what the plan does, "auto" has a place of its own before the range.
function scaleOf(p, range) {
  if (p.words) return d3.scalePoint().domain(p.words).range(range).padding(.5);
  const start = p.automatic ? range[0] + .15 * (range[1] - range[0]) : range[0];
  const numbers = (p.scale === "log" ? d3.scaleLog() : d3.scaleLinear()).domain([p.low, p.high]).range([start, range[1]]).clamp(true);
  const scale = v => isNaN(+v) ? range[0] + .05 * (range[1] - range[0]) : numbers(+v);
  for (const name of ["ticks", "domain", "tickFormat"]) scale[name] = numbers[name];
  scale.range = () => range; scale.copy = () => scaleOf(p, range);
  return scale;
}
function ticksOf(p, scale) {
  if (p.words) return p.words;
  const numbers = p.scale === "log" ? logTicks(scale, 1.6) : scale.ticks(4);
  return p.automatic ? ["auto", ...numbers] : numbers;
}

function drawPartial() {
  const scores = data.candidates.map(scoreOf).filter(v => v > 0), low = Math.max(.01, (d3.min(scores) || .5) / 1.2), high = Math.min(12, (d3.max(scores) || 2) * 1.2);
  for (const p of data.parameters) {
    const figureNode = d3.select("#partial").append("figure"), width = 330, height = 230, box = {left: 48, right: width - 8, top: 26, bottom: height - 28};
    const svg = newSvg(figureNode.append("div").attr("class", "chart"), width, height, `${p.name}: candidates by value and by time for the default's error; default ${p.default}, tuned ${p.tuned}`);
    const x = scaleOf(p, [box.left, box.right]), y = d3.scaleLog().domain([Math.min(low, .8), Math.max(high, 1.3)]).range([box.bottom, box.top]).clamp(true);
    svg.append("text").attr("x", box.left).attr("y", 14).attr("font-weight", 600).text(p.name + (p.unit ? ", " + p.unit : ""));
    svg.append("g").attr("class", "grid").append("line").attr("x1", box.left).attr("x2", box.right).attr("y1", y(1)).attr("y2", y(1)).attr("stroke-width", 2);
    svg.append("g").attr("transform", `translate(0,${box.bottom})`).call(d3.axisBottom(x).tickValues(ticksOf(p, x)).tickFormat(v => typeof v === "string" ? v : figure(v)));
    svg.append("g").attr("transform", `translate(${box.left},0)`).call(d3.axisLeft(y).tickValues(logTicks(y, 1.2)).tickFormat(v => figure(v)));
    const place = v => x(v);
    for (const [value, dash] of [[p.default, "4 3"], [p.tuned, ""]]) svg.append("line").attr("stroke", "currentColor").attr("stroke-opacity", .6).attr("stroke-dasharray", dash).attr("x1", place(value)).attr("x2", place(value)).attr("y1", box.top).attr("y2", box.bottom);
    const dots = svg.append("g").selectAll("circle").data(data.candidates).enter().append("circle").attr("r", c => 1.6 + 1.1 * c.relmse_cost_over_default.length).attr("fill", c => scoreOf(c) < 1 ? good : bad).attr("fill-opacity", .65).attr("cx", c => place(valueOf(c, p)) || 0).attr("cy", c => y(scoreOf(c)));
    tipFor(dots, c => `${c.origin}: ${figure(scoreOf(c))} of the default's time\n${listed(c.settings)}`);
    if (p.curve.length) {
      const shape = d3.line().x(q => x(q[0])).y(q => y(q[1]));
      svg.append("path").attr("fill", "none").attr("stroke", "currentColor").attr("stroke-width", 2).attr("d", shape(p.curve));
    }
    figureNode.append("figcaption").text(p.help);
  }
}

function drawParallel() {
  const ps = data.parameters, width = widthOf("parallel"), height = 340, top = 60, bottom = height - 26;
  const svg = newSvg("parallel", width, height, "Parallel coordinates of all candidates; the table below holds the values.");
  const across = i => ps.length < 2 ? width / 2 : 60 + i * (width - 130) / (ps.length - 1);
  const scales = ps.map(p => scaleOf(p, [bottom, top]));
  const path = settings => d3.line()(ps.map((p, i) => [across(i), scales[i](valueOf({settings}, p))]));
  const hue = d3.scaleLinear().domain([Math.log(.4), 0, Math.log(2.5)]).range([good, "#999999", bad]).clamp(true);
  const sorted = data.candidates.slice().sort((a, b) => scoreOf(b) - scoreOf(a));
  const lines = svg.append("g").selectAll("path").data(sorted).enter().append("path").attr("fill", "none").attr("stroke", c => hue(Math.log(scoreOf(c)))).attr("stroke-opacity", .55).attr("stroke-width", c => .8 + .7 * c.relmse_cost_over_default.length).attr("d", c => path(c.settings));
  lines.on("mousemove", function () { const c = d3.select(this).datum(); showTip(d3.event.clientX, d3.event.clientY, `${c.origin}: ${figure(scoreOf(c))} of the default's time\n${listed(c.settings)}`); }).on("mouseleave", () => tip.style("display", "none"));
  svg.append("path").attr("fill", "none").attr("stroke", "currentColor").attr("stroke-dasharray", "6 4").attr("stroke-width", 2).attr("d", path({}));
  svg.append("path").attr("fill", "none").attr("stroke", "currentColor").attr("stroke-width", 3.5).attr("d", path(tuned.settings));
  ps.forEach((p, i) => {
    svg.append("g").attr("transform", `translate(${across(i)},0)`).call(d3.axisLeft(scales[i]).tickValues(ticksOf(p, scales[i])).tickFormat(v => typeof v === "string" ? v : figure(v)));
    svg.append("text").attr("x", across(i)).attr("y", i % 2 ? 38 : 18).attr("text-anchor", "middle").text(p.name);
  });
}

function addTable(id, header, rows) {
  const table = d3.select("#" + id).append("table");
  table.append("thead").append("tr").selectAll("th").data(header).enter().append("th").attr("scope", "col").text(h => h);
  table.append("tbody").selectAll("tr").data(rows).enter().append("tr").selectAll("td").data(r => r).enter().append("td").text(c => c);
}

function halvesOf(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)), view = new DataView(bytes.buffer), values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i) {
    const h = view.getUint16(2 * i, true), e = h >> 10 & 31, m = h & 1023, s = h & 32768 ? -1 : 1;
    values[i] = s * (e === 0 ? m * 2 ** -24 : e === 31 ? (m ? NaN : Infinity) : (1 + m / 1024) * 2 ** (e - 15));
  }
  return values;
}
const shown = data.pictures.map(p => ({...p, values: halvesOf(p.halves)}));
function develop() {
  const gain = 2 ** +$("exposure").value;
  $("exposure-value").textContent = $("exposure").value + " EV";
  for (const p of shown) {
    const context = p.canvas.getContext("2d"), image = context.createImageData(p.width, p.height);
    for (let i = 0; i < p.width * p.height; ++i) {
      for (let c = 0; c < 3; ++c) { const v = Math.min(1, Math.max(0, gain * p.values[3 * i + c])); image.data[4 * i + c] = 255 * (v <= .0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - .055); }
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }
}
function drawPictures() {
  for (const p of shown) {
    const node = d3.select("#pictures").append("figure");
    p.canvas = node.append("canvas").attr("width", p.width).attr("height", p.height).attr("role", "img").attr("aria-label", p.name).node();
    node.append("figcaption").text(p.name);
  }
  $("exposure").addEventListener("input", develop);
  develop();
}

function tellVerdict() {
  const own = tuned.points[tuned.points.length - 1], base = standard.points[standard.points.length - 1], unit = nominal ? " nominal seconds" : " s";
  const lines = [];
  if (tuned === standard) lines.push(`The default stands: nothing that was tried is surely better. Its error at ${figure(base.seconds.value)}${unit} is ${percent(base.error.value)}.`);
  else {
    const r = own.relmse_cost_over_default;
    lines.push(`At ${figure(own.seconds.value)}${unit} the tuned settings have an error of ${percent(own.error.value)}, the default ${percent(base.error.value)} at ${figure(base.seconds.value)}${unit}.`);
    lines.push(`They reach the default's error in ${figure(r.value)} of its time` + (r.low === null ? "." : ` (95 %: ${figure(r.low)} to ${figure(r.high)}), measured on ${data.seeds} seeds that the search has not seen.`));
  }
  if (!data.chosen.reached) lines.push(`No settings reach an error of ${percent(data.goal.value)} within the measured times; tuned.toml holds what comes nearest.`);
  d3.select("#verdict").selectAll("p").data(lines).enter().append("p").text(l => l);
  $("settings").textContent = Object.entries(tuned.settings).map(([k, v]) => `${k} = ${v}`).join("\n") || "# as the plan decides";
  $("facts").textContent = `${data.width} × ${data.height}, ${data.seeds} seeds, ${data.candidates.length} candidates in ${data.rounds} round${data.rounds === 1 ? "" : "s"}, ` + (data.iterations ? `${data.iterations} iterations, costs in ${data.unit}` : `${figure(data.budget)} s of tuning`) + `, Pellucid ${data.version}`;
  if (data.reference.remark) { $("remarks").hidden = false; $("remarks").textContent = data.reference.remark; }
}

tellVerdict(); drawFront(); drawWorth(); drawPartial(); drawParallel(); drawPictures();
addTable("figures", ["settings", "seeds", nominal ? "nominal seconds" : "seconds", "error", "95 %", "time for the default's error", "95 %", "on the front"],
  data.finalists.flatMap(f => f.points.map(p => [f.name, p.seeds, figure(p.seconds.value), percent(p.error.value), p.error.low === null ? "" : percent(p.error.low) + " to " + percent(p.error.high), figure(p.relmse_cost_over_default.value), p.relmse_cost_over_default.low === null ? "" : figure(p.relmse_cost_over_default.low) + " to " + figure(p.relmse_cost_over_default.high), p.on_front ? "yes" : ""])));
addTable("candidates", ["origin", "time for the default's error, by level", "settings"], data.candidates.map(c => [c.origin, c.relmse_cost_over_default.map(v => figure(v)).join(", "), listed(c.settings)]));
const commands = [data.command, `pellucid render SCENE --config tuned.toml --time ${figure(data.chosen.seconds)} -o out.exr`];
d3.select("#commands").selectAll("pre").data(commands).enter().append("pre").text(c => c);
let resizing = 0;
addEventListener("resize", () => { clearTimeout(resizing); resizing = setTimeout(() => { drawFront(); drawWorth(); drawParallel(); }, 150); });
