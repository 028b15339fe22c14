#pragma once

namespace misfit::report {

/// Style sheet of the page: sober, light or dark as the reader's screen is, readable on narrow screens and in print; no font or picture
/// from elsewhere. Drawings are made for white paper: on a dark screen they are inverted, with their hues turned back.
inline constexpr const char* page_style = R"css(
:root { color-scheme: light dark; --paper: #fff; --box: #f2f6f9; --ink: #1d2327; --soft: #5b6670; --line: #d9dee2; --accent: #0b5c8c;
  --bad: #a63a00; }
@media screen and (prefers-color-scheme: dark) { :root { --paper: #191919; --box: #22292e; --ink: #e4e7ea; --soft: #a3adb5; --line: #3a4147;
  --accent: #7cc0ea; --bad: #ff9d66; } figure svg { filter: invert(.902) hue-rotate(180deg); } }
* { box-sizing: border-box; }
html { scroll-padding-top: 5rem; }
body { margin: 0 auto; max-width: 66rem; padding: 1rem 1.25rem 4rem; color: var(--ink); background: var(--paper);
  font: 16px/1.5 "Segoe UI", "Helvetica Neue", Helvetica, Arial, "DejaVu Sans", sans-serif; }
.brand { margin: 0; color: var(--soft); letter-spacing: .12em; text-transform: uppercase; font-size: .75rem; }
h1 { margin: .1rem 0 .4rem; font-size: 1.7rem; line-height: 1.2; font-weight: 600; overflow-wrap: anywhere; }
h2 { margin: 1.6rem 0 .5rem; padding-bottom: .25rem; border-bottom: 1px solid var(--line); font-size: 1.25rem; font-weight: 600; }
h3 { margin: 1.4rem 0 .4rem; font-size: 1.05rem; font-weight: 600; }
p { margin: .5rem 0; max-width: 50rem; } p, li, figcaption, summary { overflow-wrap: anywhere; }
nav { position: sticky; top: 0; z-index: 1; padding: .4rem 0; background: var(--paper); border-bottom: 2px solid var(--ink); }
nav ul { list-style: none; display: flex; flex-wrap: wrap; gap: .1rem 1.1rem; padding: 0; margin: 0; font-size: .85rem; }
a { color: var(--accent); text-decoration: none; }
a:hover { text-decoration: underline; }
ul { padding-left: 1.2rem; }
main li { max-width: 50rem; margin: .2rem 0; }
section:first-child { margin-top: 1rem; padding: .1rem 1.25rem .6rem; background: var(--box); border-left: 4px solid var(--accent); }
section:first-child figure { margin: .8rem 0 .4rem; }
.answer { font-size: 1.2rem; font-weight: 600; line-height: 1.35; }
.question { font-style: italic; color: var(--soft); }
.command { font: .9rem "DejaVu Sans Mono", Consolas, monospace; overflow-wrap: anywhere; }
summary { cursor: pointer; }
summary h2 { display: inline-block; width: calc(100% - 1.6rem); margin: .5rem 0; font-size: 1.1rem; }
details.inner { margin: .8rem 0; }
details.inner > summary { color: var(--accent); }
details.choice { margin: .3rem 0; padding: .1rem .8rem; border: 1px solid var(--line); }
details.choice[open] { border-left: 4px solid var(--accent); }
details.choice > summary { padding: .25rem 0; font-weight: 600; }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; font-size: .9rem; }
th, td { padding: .28rem 1rem .28rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; }
th.number, td.number { text-align: right; font-variant-numeric: tabular-nums; }
td.number { white-space: nowrap; }
.bad { color: var(--bad); }
.warnings { list-style: "!  "; }
.warnings li::marker { color: var(--bad); font-weight: 600; }
figure { margin: 1rem 0 1.4rem; }
figure svg { display: block; width: 100%; height: auto; }
figcaption { max-width: 50rem; margin-top: .3rem; font-size: .9rem; color: var(--soft); }
figcaption .note { display: block; color: var(--ink); }
figcaption .files { white-space: nowrap; font-size: .8rem; }
code { font: .85rem "DejaVu Sans Mono", Consolas, monospace; overflow-wrap: anywhere; }
@media (max-width: 44rem) { body { padding: .8rem .8rem 3rem; font-size: 15px; } h1 { font-size: 1.35rem; } .answer { font-size: 1.05rem; }
  nav { position: static; } html { scroll-padding-top: 0; } section:first-child { padding: .1rem .8rem .4rem; } }
@media screen and (max-width: 44rem) { .drawing { cursor: zoom-in; } .drawing:focus { cursor: auto; } .drawing:focus svg { width: 42rem; }
  .drawing:not(:focus)::after { content: "Larger: tap it"; display: block; text-align: right; font-size: .8rem; color: var(--soft); } }
@media print { body { max-width: none; padding: 0; font-size: 10pt; } nav { display: none; } a { color: inherit; } h2 { margin-top: 1rem; }
  figure, tr, .warnings li { break-inside: avoid; } h2, h3, summary { break-after: avoid; } .wide { overflow: visible; }
  table { font-size: min(8.5pt, calc(145vw / var(--letters, 1))); } th, td { padding-right: 1em; } td.number { white-space: normal; }
  figure { display: inline-block; width: 49.5%; margin: .3rem 0 .6rem; padding-right: 1.5%; vertical-align: top; } figcaption { font-size: 8pt; line-height: 1.3; }
  section:first-child figure { display: block; width: auto; padding: 0; }
  section:first-child figure svg { max-height: 6.5cm; } main ul { columns: 2; column-gap: 2.5em; } main li { break-inside: avoid; }
  summary { list-style: none; } figcaption .files { display: none; }
  details::details-content { content-visibility: visible; height: auto; } details:not([open])::details-content { display: block; } }
)css";

}  // namespace misfit::report
