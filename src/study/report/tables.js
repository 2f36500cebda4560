// The page's words and tables, and the start of everything.
"use strict";
function addTable(id, head, rows, words = false) {
  const table = d3.select("#" + id).append("table").classed("words", words);
  table.append("thead").append("tr").selectAll("th").data(head).enter().append("th").attr("scope", "col").text(h => h);
  const cells = table.append("tbody").selectAll("tr").data(rows).enter().append("tr").selectAll("td").data(r => r).enter().append("td");
  cells.each(function (c) {
    const cell = d3.select(this);
    const rich = typeof c === "object" ? c : {text: c};
    if (rich.swatch) cell.append("span").attr("class", "swatch").style("background", rich.swatch);
    cell.append("span").text(rich.text);
    if (rich.small) cell.append("small").text(rich.small);
  });
  return table;
}
const withRange = i => ({text: figure(i.value), small: between(i)});
const named = m => ({text: m.method, swatch: colourOf(m.method)});

function writeFacts() {
  const r = summary.reference, s = summary;
  $("facts").textContent = `${s.width}×${s.height}, ${s.seeds} ${s.seeds === 1 ? "seed" : "seeds"}, budgets of ${s.times.map(t => figure(t)).join(", ")} s, ${s.threads} threads, pellucid ${s.version}. Reference: ${r.file.split("/").pop()}` +
    (r.made ? `, made in ${figure(r.seconds)} s` : "") + (r.noise_relmse !== null ? `, its own error ${figure(100 * Math.sqrt(r.noise_relmse), 2)} %` : "") + ".";
  const remarks = [r.remark, s.runs_missing > 0 ? `${s.runs_missing} of ${s.runs + s.runs_missing} runs are missing: the comparison was interrupted. The command under Repeat it goes on from here` : ""].filter(t => t);
  for (const run of report.runs) for (const blind of run.blind_spots || []) { const text = `${run.method} cannot see: ${blind}`; if (!remarks.includes(text)) remarks.push(text); }
  $("remarks").hidden = !remarks.length;
  $("remarks").textContent = remarks.map(t => t.replace(/\.?$/, ".")).join(" ");
}

// The best at the longest time that all have, and whether it is told apart from the others.
function writeVerdict() {
  const measured = methods.filter(m => m.points.length), box = d3.select("#verdict");
  const budget = d3.max(summary.times.filter(t => measured.every(m => m.points.some(p => p.budget === t))));  // an interrupted comparison lacks some
  if (!measured.length || budget === undefined) { box.append("p").text("No time has runs of every method yet."); return; }
  const last = m => m.points.find(p => p.budget === budget), ranked = measured.sort((a, b) => last(a).relmse.value - last(b).relmse.value), best = ranked[0];
  box.append("p").text(`At ${figure(budget)} s ${best.method} has the smallest error: ${figure(100 * Math.sqrt(last(best).relmse.value))} % (relMSE ${figure(last(best).relmse.value)}, of it bias² ${figure(last(best).bias2.value)} and variance ${figure(last(best).variance.value)}).`);
  for (const other of ranked.slice(1)) {
    const pair = summary.comparisons.find(c => c.budget === budget && [c.a, c.b].includes(best.method) && [c.a, c.b].includes(other.method));
    if (!pair) continue;
    const turned = pair.a === best.method, ratio = pair.relmse_ratio, value = turned ? 1 / ratio.value : ratio.value;
    const ends = ratio.low === null ? "" : ` (${figure(turned ? 1 / ratio.high : ratio.low)} to ${figure(turned ? 1 / ratio.low : ratio.high)})`;
    box.append("p").text(`${other.method}: ${figure(100 * Math.sqrt(last(other).relmse.value))} %, ${figure(value)} times the relMSE${ends}; ` +
      (pair.significant ? `told apart, p = ${figure(pair.p_adjusted, 2)} after Holm.` : `not told apart with ${last(other).seeds} seeds (p = ${figure(pair.p_adjusted, 2)} after Holm).`));
  }
  const fewest = d3.min(methods.flatMap(m => m.points), p => p.seeds), needed = summary.seeds_needed || 0;
  if (fewest < needed) box.append("p").attr("class", "hint").text(`With ${fewest} ${fewest === 1 ? "seed" : "seeds"} no difference can be told from chance: ${summary.comparisons.length} comparisons need --seeds ${needed}.`);
}

function writeFigures() {
  addTable("figures", ["method", "budget", "seconds", "relMSE", "bias²", "variance", "trimmed", "RMSE", "SMAPE", "FLIP", "mean bias", "efficiency", "peak MB"],
    methods.flatMap(m => m.points.map(p => [named(m), figure(p.budget), figure(p.seconds.value), withRange(p.relmse), withRange(p.bias2), withRange(p.variance), withRange(p.relmse_trimmed),
      withRange(p.rmse), withRange(p.smape), withRange(p.flip), withRange(p.bias), withRange(p.efficiency), figure(p.peak_rss_bytes / 1e6)])));
  const time = t => ({text: t.status === "reached" ? figure(t.seconds) : t.status === "at the first budget or before" ? "≤ " + figure(t.seconds) : t.status === "not reached" && t.low !== null ? "> " + figure(t.low) : t.status,
    small: t.status === "reached" && t.low !== null ? figure(t.low) + " to " + (t.high === null ? "never" : figure(t.high)) : ""});
  addTable("times", ["method", "slope"].concat(methods[0].time_to_error.map(t => `s to ${figure(100 * t.error)} %`)), methods.map(m => [named(m), withRange(m.slope)].concat(m.time_to_error.map(time))));
  addTable("pairs", ["pair", "time, s", "ratio of relMSE", "p", "p, adjusted", "differ"], summary.comparisons.map(c => [`${c.a} / ${c.b}`, figure(c.budget), withRange(c.relmse_ratio), figure(c.p, 2), figure(c.p_adjusted, 2), c.significant ? "yes" : "not told apart"]));
  d3.select("#pairs").append("p").attr("class", "hint").text("Permutation test of log relMSE over the seeds; p adjusted by Holm for the whole table, so that the chance of any false “yes” stays below 5 %.");
}

// The command that renders one run, with what was set; quoted for a shell where it has to be.
function renderCommand(m) {
  const quoted = t => /^[\w.\-+=,:\/%@]+$/.test(t) ? t : "'" + t.replace(/'/g, "'\\''") + "'";
  const words = ["pellucid", "render", summary.scene, "-o", m.method.replace(/[^\w.\-]/g, "_") + ".exr", "--method", m.integrator, "--time", summary.times[summary.times.length - 1],
    "--seed", summary.first_seed, "--size", `${summary.width}x${summary.height}`, "--threads", summary.threads];
  if (summary.camera) words.push("--camera", summary.camera);
  if (summary.environment) words.push("--env", summary.environment);
  for (const [name, value] of Object.entries(m.settings)) words.push("--set", `${name}=${value}`);
  return words.map(w => quoted(String(w))).join(" ");
}

// A setting's text; numbers with more than nine digits are cut to six, the files keep them all.
const shortened = text => text.length > 9 && isFinite(text) ? figure(+text, 6) : text;

function writeSettings() {
  const first = methods.map(m => report.runs.find(r => r.method === m.method)), names = [...new Set(first.flatMap(r => r ? Object.keys(r.settings) : []))];
  addTable("settings", ["setting"].concat(methods.map(m => m.method)), names.map(n => [n].concat(first.map((r, i) => {
    const value = r ? shortened(r.settings[n]) : "–", differs = report.runs.some(q => q.method === methods[i].method && q.settings[n] !== r.settings[n]);
    return {text: value + (n in methods[i].settings ? " (set)" : ""), small: differs ? "differs between runs" : ""};
  }))), true);
  for (const [i, run] of report.runs.entries()) {
    const details = d3.select("#plans").append("details");
    const budgets = [...new Set(run.runs.map(r => r.budget))].map(b => `${figure(b)} s (seeds ${run.runs.filter(r => r.budget === b).map(r => r.seed).join(", ")})`);
    details.append("summary").text(`${run.method}: ${budgets.join("; ")}`);
    details.append("div").attr("class", "scroll").attr("id", "plan-" + i);
    addTable("plan-" + i, ["decision", "choice", "reason"], run.plan.map(d => [d.name, d.choice + (d.overridden ? " (set)" : ""), d.reason]), true);
  }
  d3.select("#commands").append("pre").text(summary.command);
  d3.select("#commands").append("p").text("One run alone, at the longest time and with the first seed:");
  d3.select("#commands").append("pre").text(methods.map(renderCommand).join("\n"));
  d3.select("#commands").append("p").attr("class", "hint").text("Finished runs in the folder are not rendered again; delete the folder, or give another one, to measure anew. Times depend on the machine: run nothing else beside it.");
}


d3.select("#metric").selectAll("option").data(metrics).enter().append("option").text(m => m[1]);
d3.select("#class-budget").selectAll("option").data(summary.times.slice().reverse()).enter().append("option").attr("value", t => t).text(t => figure(t) + " s");
writeFacts(); writeVerdict(); drawLegend(); writeFigures(); writeSettings(); startViewer(); startMaps();
function redraw() { drawCurves(); drawClasses(); drawStages(); }
$("metric").onchange = $("show-runs").onchange = drawCurves; $("class-budget").onchange = $("class-scale").onchange = drawClasses;
let resizing; addEventListener("resize", () => { clearTimeout(resizing); resizing = setTimeout(redraw, 120); });
addEventListener("beforeprint", () => { for (const d of document.querySelectorAll("details")) d.open = true; });
redraw();
document.documentElement.dataset.ready = "true";
