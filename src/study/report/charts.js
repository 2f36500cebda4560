// Data of the page and its charts: curves of error against time, bars by path class and by stage. D3 does scales, axes and
// shapes; colours come with a dash and a symbol, so that no method is known by colour alone.
"use strict";
const report = JSON.parse(document.getElementById("data").textContent);
const summary = report.summary, methods = summary.methods;
const $ = id => document.getElementById(id);
const hues = ["#0b78c2", "#d1591a", "#17936b", "#b4509c", "#a88a00", "#5a63c8", "#c2334d", "#5c7c8a"];
const dashes = ["", "7 4", "2 3", "9 3 2 3", "12 4", "4 4"];
const colourOf = name => hues[methods.findIndex(m => m.method === name) % hues.length];
const dashOf = name => dashes[methods.findIndex(m => m.method === name) % dashes.length];
const symbolOf = name => d3.symbols[methods.findIndex(m => m.method === name) % d3.symbols.length];
const figure = (v, digits = 3) => v === null || v === undefined || !isFinite(v) ? "–" : Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-4) ?
  v.toExponential(digits - 1).replace("e", "e") : String(+v.toPrecision(digits));
const between = i => i && i.low !== null && i.high !== null ? `${figure(i.low)} to ${figure(i.high)}` : "";
const hidden = new Set();

const metrics = [
  ["error", "error, √relMSE", p => rooted(p.relmse), r => Math.sqrt(r.relmse)], ["relmse", "relMSE", p => p.relmse, r => r.relmse],
  ["relmse_trimmed", "relMSE without the worst 0.1 % of pixels", p => p.relmse_trimmed, r => r.relmse_trimmed],
  ["bias2", "bias², relative", p => p.bias2, null], ["variance", "variance, relative", p => p.variance, null],
  ["rmse", "RMSE", p => p.rmse, r => r.rmse], ["smape", "SMAPE", p => p.smape, r => r.smape], ["flip", "HDR-FLIP", p => p.flip, r => r.flip]];
function rooted(i) { const root = v => v === null ? null : Math.sqrt(Math.max(0, v)); return {value: root(i.value), low: root(i.low), high: root(i.high)}; }

const tip = d3.select("body").append("div").attr("class", "tip").attr("role", "status").style("display", "none");
function showTip(event, text) {
  tip.style("display", "block").text(text);
  const box = tip.node().getBoundingClientRect();
  tip.style("left", Math.max(4, Math.min(innerWidth - box.width - 8, event.clientX + 12)) + "px")
    .style("top", Math.max(4, event.clientY - box.height - 10) + "px");
}
function tipFor(selection, textOf) {
  selection.on("mousemove", function () { showTip(d3.event, textOf(d3.select(this).datum())); }).on("mouseleave", () => tip.style("display", "none"))
    .on("focus", function () { const b = this.getBoundingClientRect(); showTip({clientX: b.right, clientY: b.top}, textOf(d3.select(this).datum())); })
    .on("blur", () => tip.style("display", "none"));
}

function chartWidth(id) { return Math.max(300, Math.min(1080, $(id).clientWidth || 1000)); }
function newSvg(id, width, height, label) {
  d3.select("#" + id).selectAll("*").remove();
  return d3.select("#" + id).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "img").attr("aria-label", label);
}
// Powers of ten, and their multiples where the axis is short.
function logTicks(scale, room) {
  const [low, high] = scale.domain(), ticks = [];
  const decades = Math.log10(high / low), steps = decades > room ? [1] : decades > 1.3 ? [1, 2, 5] : [1, 2, 3, 5, 7];
  for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); ++e) for (const s of steps) { const v = s * 10 ** e; if (v >= low * .999 && v <= high * 1.001) ticks.push(v); }
  return ticks;
}

function drawCurves() {
  const [, title, ofPoint, ofRun] = metrics[$("metric").selectedIndex];
  const width = chartWidth("curves"), height = Math.min(520, Math.max(320, width * .5)), box = {left: 86, right: width - 16, top: 12, bottom: height - 46};
  const svg = newSvg("curves", width, height, `${title} against seconds, both axes logarithmic, for ${methods.map(m => m.method).join(", ")}. The table under Figures holds the values.`);
  const shown = methods.filter(m => !hidden.has(m.method)).map(m => ({name: m.method, points: m.points.map(p => ({p, x: p.seconds.value, i: ofPoint(p)})).filter(q => q.i.value > 0)}));
  const runs = ofRun && $("show-runs").checked ? report.curves.filter(r => !hidden.has(r.method) && ofRun(r) > 0) : [];
  const xs = shown.flatMap(s => s.points.map(q => q.x)).concat(runs.map(r => r.seconds)), ys = shown.flatMap(s => s.points.flatMap(q => [q.i.value, q.i.low > q.i.value / 20 ? q.i.low : q.i.value, q.i.high || q.i.value])).concat(runs.map(ofRun));
  if (!xs.length) { svg.append("text").attr("x", width / 2).attr("y", height / 2).attr("text-anchor", "middle").text(methods.some(m => m.points.length) ? "Nothing above zero to draw on logarithmic axes." : "No runs."); return; }
  const x = d3.scaleLog().domain([d3.min(xs) / 1.25, d3.max(xs) * 1.25]).range([box.left, box.right]);
  const y = d3.scaleLog().domain([d3.min(ys) / 1.3, d3.max(ys) * 1.3]).range([box.bottom, box.top]).clamp(true);
  const xTicks = logTicks(x, 2.2), yTicks = logTicks(y, 2.2), percent = title.startsWith("error");
  const name = v => percent ? (v >= 1e3 ? (100 * v).toExponential(0).replace("e+", "e") : figure(100 * v)) + " %" : figure(v);
  svg.append("g").attr("class", "grid").selectAll("line").data(yTicks).enter().append("line").attr("x1", box.left).attr("x2", box.right).attr("y1", y).attr("y2", y);
  svg.append("g").attr("class", "grid").selectAll("line").data(xTicks).enter().append("line").attr("x1", x).attr("x2", x).attr("y1", box.top).attr("y2", box.bottom);
  svg.append("g").attr("transform", `translate(0,${box.bottom})`).call(d3.axisBottom(x).tickValues(xTicks).tickFormat(v => figure(v)));
  svg.append("g").attr("transform", `translate(${box.left},0)`).call(d3.axisLeft(y).tickValues(yTicks).tickFormat(name));
  svg.append("text").attr("x", (box.left + box.right) / 2).attr("y", height - 6).attr("text-anchor", "middle").text("seconds, with loading and all preprocessing");
  svg.append("text").attr("transform", `translate(14,${(box.top + box.bottom) / 2}) rotate(-90)`).attr("text-anchor", "middle").text(title);
  for (const s of shown) {
    const group = svg.append("g").attr("class", "curve").attr("data-method", s.name), colour = colourOf(s.name), banded = s.points.filter(q => q.i.low !== null && q.i.high !== null);
    group.append("path").attr("fill", colour).attr("fill-opacity", .17).attr("d", d3.area().x(q => x(q.x)).y0(q => y(Math.max(q.i.low, y.domain()[0]))).y1(q => y(q.i.high))(banded));
    group.selectAll("line.bar").data(banded).enter().append("line").attr("class", "bar").attr("stroke", colour).attr("x1", q => x(q.x)).attr("x2", q => x(q.x)).attr("y1", q => y(Math.max(q.i.low, y.domain()[0]))).attr("y2", q => y(q.i.high));
    group.append("path").attr("class", "line").attr("fill", "none").attr("stroke", colour).attr("stroke-width", 2.4).attr("stroke-dasharray", dashOf(s.name)).attr("d", d3.line().x(q => x(q.x)).y(q => y(q.i.value))(s.points));
    group.selectAll("circle").data(runs.filter(r => r.method === s.name)).enter().append("circle").attr("r", 2).attr("fill", colour).attr("fill-opacity", .5).attr("cx", r => x(r.seconds)).attr("cy", r => y(ofRun(r)));
    const marks = group.selectAll("path.mark").data(s.points).enter().append("path").attr("class", "mark").attr("tabindex", 0).attr("fill", colour).attr("d", d3.symbol().type(symbolOf(s.name)).size(90)).attr("transform", q => `translate(${x(q.x)},${y(q.i.value)})`).attr("role", "img");
    const text = q => `${s.name}, ${figure(q.x)} s\n${title} ${name(q.i.value)}\n${q.i.low === null ? "one seed: no interval" : "95 %: " + name(q.i.low) + " to " + name(q.i.high)}`;
    marks.attr("aria-label", text); tipFor(marks, text);
  }
}

function drawLegend() {
  const buttons = d3.select("#legend").selectAll("button").data(methods).enter().append("button").attr("type", "button").attr("aria-pressed", "true").attr("title", "show or hide");
  const swatch = buttons.append("svg").attr("class", "swatch").attr("viewBox", "0 0 22 12").attr("aria-hidden", "true");
  swatch.append("line").attr("x2", 22).attr("y1", 6).attr("y2", 6).attr("stroke", m => colourOf(m.method)).attr("stroke-width", 2.4).attr("stroke-dasharray", m => dashOf(m.method));
  swatch.append("path").attr("transform", "translate(11,6)").attr("fill", m => colourOf(m.method)).attr("d", m => d3.symbol().type(symbolOf(m.method)).size(50)());
  buttons.append("span").text(m => m.method);
  buttons.on("click", function () {
    const name = d3.select(this).datum().method;
    hidden.has(name) ? hidden.delete(name) : hidden.add(name);
    this.setAttribute("aria-pressed", String(!hidden.has(name)));
    drawCurves();
  });
}

function drawClasses() {
  const budget = +$("class-budget").value, groups = [];
  for (const m of methods) { const p = m.points.find(q => q.budget === budget); if (p) for (const [name, c] of Object.entries(p.classes)) groups.push({method: m.method, name, c}); }
  if (!groups.length) { $("classes").textContent = "The reference has no layers direct, caustic and indirect: give one of this program, or let compare make it."; $("classes-note").hidden = true; return; }
  const names = ["direct", "caustic", "indirect"].filter(n => groups.some(g => g.name === n)), width = chartWidth("classes"), rows = groups.length;
  // One scale for all shows which class the error comes from; one for each class, how the methods stand within it. An interval
  // may reach far beyond the bars: the scale ends at three times the longest of them.
  const own = $("class-scale").value === "own", height = rows * 24 + names.length * (own ? 64 : 30) + (own ? 4 : 46), left = Math.min(width * .4, 250);
  const end = list => Math.min(d3.max(list, g => Math.max(g.c.relmse.value, g.c.relmse.high || 0)), 3 * d3.max(list, g => g.c.relmse.value)) || 1;
  const scaleOf = list => d3.scaleLinear().domain([0, end(list)]).nice().range([left, width - 70]).clamp(true);
  const axis = (x, y) => svg.append("g").attr("transform", `translate(0,${y})`).call(d3.axisBottom(x).ticks(width < 500 ? 3 : 6).tickFormat(v => figure(v)));
  const svg = newSvg("classes", width, height, "relMSE by path class: " + groups.map(g => `${g.name}, ${g.method}: ${figure(g.c.relmse.value)}`).join("; "));
  let top = 4, x = scaleOf(groups);
  for (const name of names) {
    if (own) x = scaleOf(groups.filter(g => g.name === name));
    svg.append("text").attr("x", 0).attr("y", top + 18).attr("font-weight", 600).text(name); top += 26;
    for (const g of groups.filter(q => q.name === name)) {
      const bias = Math.max(0, g.c.bias2.value || 0), whole = g.c.relmse.value, colour = colourOf(g.method), row = svg.append("g").datum(g);
      row.append("text").attr("x", left - 8).attr("y", top + 15).attr("text-anchor", "end").text(g.method.length > left / 7.6 ? g.method.slice(0, left / 7.6 - 1) + "…" : g.method);
      row.append("rect").attr("x", x(0)).attr("y", top + 3).attr("height", 16).attr("width", x(whole) - x(0)).attr("fill", colour).attr("fill-opacity", .35);
      row.append("rect").attr("x", x(0)).attr("y", top + 3).attr("height", 16).attr("width", x(Math.min(bias, whole)) - x(0)).attr("fill", colour);
      if (g.c.relmse.low !== null) row.append("line").attr("stroke", "currentColor").attr("x1", x(Math.max(0, g.c.relmse.low))).attr("x2", x(g.c.relmse.high)).attr("y1", top + 11).attr("y2", top + 11);
      row.append("text").attr("x", x(Math.max(whole, g.c.relmse.high || 0)) + 6).attr("y", top + 15).text(figure(whole));
      tipFor(row, q => `${q.method}, ${q.name}\nrelMSE ${figure(q.c.relmse.value)}  (${between(q.c.relmse)})\nbias² ${figure(q.c.bias2.value)}  (${between(q.c.bias2)})\nvariance ${figure(q.c.variance.value)}  (${between(q.c.variance)})`);
      top += 24;
    }
    if (own) { axis(x, top + 4); top += 34; }
    top += 4;
  }
  if (!own) axis(x, top + 4);
}

function drawStages() {
  const rows = methods.filter(m => m.points.length).map(m => ({m, stages: m.points[m.points.length - 1].stages.filter(s => s.seconds > 0), total: m.points[m.points.length - 1].seconds.value}));
  const names = [...new Set(rows.flatMap(r => r.stages.map(s => s.name)))], width = chartWidth("stages"), left = Math.min(width * .4, 250);
  const perLine = Math.max(1, Math.floor(width / 170)), legendHeight = Math.ceil((names.length + 1) / perLine) * 22 + 8;
  const svg = newSvg("stages", width, legendHeight + rows.length * 28 + 34, "Seconds by stage: " + rows.map(r => `${r.m.method}: ${r.stages.map(s => s.name + " " + figure(s.seconds)).join(", ")}`).join("; "));
  const x = d3.scaleLinear().domain([0, d3.max(rows, r => r.total) || 1]).range([left, width - 20]), colour = s => s === "other" ? "#8a8f98" : hues[names.indexOf(s) % hues.length];
  names.concat("other").forEach((s, i) => { const g = svg.append("g").attr("transform", `translate(${i % perLine * 170},${Math.floor(i / perLine) * 22})`); g.append("rect").attr("width", 14).attr("height", 14).attr("y", 2).attr("fill", colour(s)); g.append("text").attr("x", 20).attr("y", 14).text(s === "other" ? "other (loading)" : s); });
  rows.forEach((r, i) => {
    const top = legendHeight + i * 28; let from = 0;
    svg.append("text").attr("x", left - 8).attr("y", top + 16).attr("text-anchor", "end").text(r.m.method.length > left / 7.6 ? r.m.method.slice(0, left / 7.6 - 1) + "…" : r.m.method);
    const other = Math.max(0, r.total - d3.sum(r.stages, s => s.seconds));
    for (const s of r.stages.concat({name: "other", seconds: other})) {
      const bar = svg.append("rect").datum(s).attr("x", x(from)).attr("y", top + 3).attr("height", 18).attr("width", Math.max(0, x(from + s.seconds) - x(from))).attr("fill", colour(s.name)); from += s.seconds;
      tipFor(bar, q => `${r.m.method}\n${q.name}: ${figure(q.seconds)} s`);
    }
  });
  svg.append("g").attr("transform", `translate(0,${legendHeight + rows.length * 28})`).call(d3.axisBottom(x).ticks(width < 500 ? 3 : 8).tickFormat(v => v + " s"));
}
