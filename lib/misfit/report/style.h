#pragma once

namespace misfit::report {

/// Style sheet of the page: sober, readable on narrow screens and in print; no font or picture from elsewhere.
inline constexpr const char* page_style = R"css(
:root { --ink: #1d2327; --soft: #5b6670; --line: #d9dee2; --accent: #0b5c8c; --bad: #a63a00; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 62rem; padding: 1.5rem 1.25rem 4rem; color: var(--ink); background: #fff;
  font: 16px/1.55 "Segoe UI", "Helvetica Neue", Helvetica, Arial, "DejaVu Sans", sans-serif; }
header { border-bottom: 2px solid var(--ink); margin-bottom: 1rem; }
.brand { margin: 0; color: var(--soft); letter-spacing: .12em; text-transform: uppercase; font-size: .75rem; }
h1 { margin: .1rem 0 .6rem; font-size: 1.8rem; line-height: 1.2; font-weight: 600; overflow-wrap: anywhere; }
h2 { margin: 2.4rem 0 .6rem; padding-bottom: .25rem; border-bottom: 1px solid var(--line); font-size: 1.3rem; font-weight: 600; }
h3 { margin: 1.6rem 0 .4rem; font-size: 1.05rem; font-weight: 600; }
p { margin: .5rem 0; max-width: 46rem; }
.question { font-size: 1.15rem; font-style: italic; }
nav ul { list-style: none; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; padding: 0; margin: 0; font-size: .9rem; }
a { color: var(--accent); text-decoration: none; }
a:hover { text-decoration: underline; }
ul { padding-left: 1.2rem; }
main li { max-width: 46rem; margin: .2rem 0; }
.wide { overflow-x: auto; margin: .8rem 0; }
table { border-collapse: collapse; font-size: .92rem; }
th, td { padding: .32rem .9rem .32rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; }
.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.short { white-space: nowrap; }
.bad { color: var(--bad); }
.warnings { list-style: "!  "; }
.warnings li::marker { color: var(--bad); font-weight: 600; }
figure { margin: 1.4rem 0 2rem; }
figure svg { display: block; width: 100%; height: auto; }
figcaption { max-width: 46rem; margin-top: .3rem; font-size: .9rem; color: var(--soft); }
figcaption .note { display: block; color: var(--bad); }
figcaption .files { display: block; font-size: .78rem; }
code { font: .85rem "DejaVu Sans Mono", Consolas, monospace; overflow-wrap: anywhere; }
@media (max-width: 40rem) { body { padding: 1rem .8rem 3rem; font-size: 15px; } h1 { font-size: 1.4rem; } }
@media print { body { max-width: none; padding: 0; font-size: 10.5pt; } nav { display: none; } a { color: inherit; }
  figure, table { break-inside: avoid; } h2, h3 { break-after: avoid; } .wide { overflow: visible; } }
)css";

}  // namespace misfit::report
