// The page's style: dark on white, figures that line up, tables that scroll in themselves on a phone, paper that breaks
// between sections. No font and no picture from elsewhere.
#pragma once

namespace copse::report {

constexpr const char* style = R"css(
:root { color-scheme: light; --ink: #1b1f24; --soft: #59636e; --line: #d5dae0; --tint: #f4f6f8; --mark: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 70rem; padding: 2rem 1.5rem 4rem; background: #fff; color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .4rem; letter-spacing: -.01em; }
h2 { font-size: 1.3rem; margin: 2.8rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.02rem; margin: 1.8rem 0 .4rem; }
p, dl, ul { margin: .5rem 0; max-width: 46rem; }
p.lead { font-size: 1.08rem; }
p.about, .legend, figcaption, small { color: var(--soft); }
.legend, figcaption { font-size: .88rem; max-width: 54rem; }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; font-size: .86em; }
pre { background: var(--tint); padding: .8rem 1rem; overflow: auto; max-height: 30rem; }
nav { font-size: .9rem; margin: 1rem 0 0; }
nav a { margin-right: 1rem; white-space: nowrap; }
a { color: var(--mark); }
.warning { border-left: 4px solid #d55e00; background: #fdf3ec; padding: .5rem .9rem; max-width: 46rem; }
.scroll { overflow-x: auto; margin: .6rem 0 1rem; }
table { border-collapse: collapse; font-size: .9rem; line-height: 1.35; }
caption { caption-side: top; text-align: left; font-size: .88rem; color: var(--soft); padding: 0 0 .4rem; }
th, td { padding: .18rem .55rem; text-align: right; font-variant-numeric: tabular-nums; vertical-align: baseline; }
th { font-weight: 600; }
thead th { border-bottom: 1px solid var(--ink); vertical-align: bottom; }
th[scope=row], th.text, td.text { text-align: left; }
th[scope=row] { font-weight: 400; white-space: nowrap; }
tbody tr:nth-child(even) > * { background: var(--tint); }
.results { width: 100%; }
.results thead tr:first-child th { border-bottom: 0; text-align: right; }
.results thead tr:first-child th[rowspan] { border-bottom: 1px solid var(--ink); text-align: left; }
sub { line-height: 0; font-size: .75em; }
sup { line-height: 0; font-size: .7em; }
.results td { padding-right: .25rem; }
.results td.beside, .results th.beside { color: var(--soft); font-size: .78rem; font-weight: 400; padding-left: .1rem;
  text-align: left; white-space: nowrap; }
.results td.none { color: var(--soft); }
.results tr.scene > th { text-align: left; background: #fff; border-bottom: 1px solid var(--line);
  padding: 1.1rem .55rem .25rem; font-size: 1rem; }
.results tr.scene small { font-weight: 400; font-size: .82rem; margin-left: .4rem; }
.results tr.ideal > * { font-style: italic; }
.results td b { color: #000; font-weight: 700; }
thead th[rowspan], table th[scope=row] { position: sticky; left: 0; background: #fff; }
tbody tr:nth-child(even) > th[scope=row] { background: var(--tint); }
figure { margin: 1.2rem 0 2rem; }
figcaption { margin-top: .6rem; }
.panels { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 27rem), 1fr)); gap: 1rem 1.4rem; }
.panels > .wide { grid-column: 1 / -1; max-width: 52rem; }
.panels > div { max-width: 36rem; }
.panels svg { display: block; width: 100%; height: auto; }
svg text { font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
.images { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 14rem), 1fr)); gap: 1rem; }
.images figure { margin: 0; }
.images img { width: 100%; height: auto; display: block; background: var(--tint); }
dl { display: grid; grid-template-columns: minmax(7rem, max-content) 1fr; gap: .15rem 1rem; font-size: .92rem; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
summary { cursor: pointer; margin: .8rem 0 .3rem; }
.better { color: #00664b; } .worse { color: #a63f00; } .even { color: var(--soft); }
footer { margin-top: 3rem; font-size: .85rem; color: var(--soft); }
@media (max-width: 40rem) {
  body { padding: 1.2rem 1rem 3rem; }
  h1 { font-size: 1.5rem; }
  table { font-size: .84rem; }
  caption > span { position: sticky; left: 0; display: inline-block; max-width: 88vw; }
  .results tr.scene > th > span { position: sticky; left: .55rem; display: inline-block; max-width: 85vw; }
  .results tr.scene small { display: block; margin: 0; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin: 0 0 .5rem; }
}
@media print {
  @page { size: A4; margin: 15mm 14mm; }
  body { font-size: 9.5pt; max-width: none; padding: 0; }
  h1 { font-size: 17pt; } h2 { font-size: 13pt; break-after: avoid; } h3 { break-after: avoid; }
  nav { display: none; }
  .scroll { overflow: visible; }
  table { font-size: 8pt; } th, td { padding: .1rem .3rem; }
  .results td.beside, .results th.beside { font-size: 6.6pt; }
  .legend, caption, figcaption, .results tr.scene small, dl { font-size: 8.5pt; }
  .results tr.scene > th { font-size: 10pt; padding-top: .6rem; }
  thead { display: table-header-group; }
  tr, figcaption, .panels > div, .images figure { break-inside: avoid; }
  .results tbody { break-inside: avoid; }
  .panels { grid-template-columns: 1fr 1fr; gap: .6rem; }
  .images { grid-template-columns: repeat(3, 1fr); }
  pre { max-height: none; white-space: pre-wrap; }
  a { color: inherit; text-decoration: none; }
}
)css";

}  // namespace copse::report
