// SPDX-License-Identifier: Apache-2.0
#include "tools/report/report_parts.hpp"

namespace mapweld::report {

std::string_view ReportStyle() {
  return R"css(
:root { color-scheme: light dark; --page: #ffffff; --panel: #f6f7f9; --ink: #1b2530; --faint: #66727f; --line: #dfe4ea;
  --ground: #fbfbf9; --accent: #2f6fb3; --yes: #00745a; --no: #b14a00; --weld: #ffcf4d;
  --image: invert(1) hue-rotate(180deg) brightness(1.25) saturate(1.2); }
@media (prefers-color-scheme: dark) { :root { --page: #0f141a; --panel: #171e26; --ink: #e7ecf1; --faint: #98a5b3;
  --line: #2a343f; --ground: #0b0f14; --accent: #6ea8e0; --yes: #3ecfa5; --no: #ff9d57; --weld: #c9992e;
  --image: none; } }
@media print { :root { --page: #ffffff; --panel: #f6f7f9; --ink: #1b2530; --faint: #66727f; --line: #dfe4ea;
  --ground: #fbfbf9; --accent: #2f6fb3; --yes: #00745a; --no: #b14a00; --weld: #ffcf4d;
  --image: invert(1) hue-rotate(180deg) brightness(1.25) saturate(1.2); } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); -webkit-text-size-adjust: 100%;
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
main { max-width: 1184px; margin: 0 auto; padding: 36px 32px 48px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 6px; letter-spacing: -.01em; overflow-wrap: anywhere; }
h2 { font-size: 20px; line-height: 1.3; margin: 0 0 2px; }
.verdict { font-size: 19px; line-height: 1.4; margin: 0 0 22px; color: var(--ink); }
.warning { margin: 0 0 20px; padding: 10px 14px; border-left: 4px solid var(--no); background: var(--panel);
  border-radius: 4px; }
.how { margin: 0 0 14px; color: var(--faint); max-width: 96ch; }
section { margin-top: 44px; }
.tiles { display: grid; grid-template-columns: repeat(4, 1fr); gap: 12px; margin: 0; }
@media (max-width: 860px) { .tiles { grid-template-columns: repeat(2, 1fr); } main { padding: 24px 16px; } }
.tile { background: var(--panel); border: 1px solid var(--line); border-radius: 8px; padding: 12px 16px 11px; }
.tile dt { color: var(--faint); font-size: 13px; }
.tile dd { margin: 0; font-size: 26px; line-height: 1.25; font-weight: 600; font-variant-numeric: tabular-nums;
  white-space: nowrap; }
.tile small { color: var(--faint); font-size: 13px; }
.maps { display: grid; grid-template-columns: repeat(2, 1fr); gap: 26px 24px; }
figure { margin: 0; }
.map { grid-column: 1 / -1; min-width: 0; }
.map.half { grid-column: auto; }
@media (max-width: 860px) { .map.half { grid-column: 1 / -1; } }
.map > svg { display: block; width: 100%; height: auto; margin: 0 auto; background: var(--ground);
  border: 1px solid var(--line); border-radius: 8px; }
.map image { filter: var(--image); }
.casing { fill: none; stroke: var(--ground); stroke-width: 5.5; stroke-linejoin: round; stroke-linecap: round;
  opacity: .75; }
.drive { fill: none; stroke-linejoin: round; }
.weld { fill: none; stroke: var(--weld); stroke-width: 15; stroke-linejoin: round; stroke-linecap: round;
  opacity: .5; }
.cased { stroke: var(--ground); stroke-width: 1.5; }
.badge { font-size: 12px; font-weight: 700; fill: #10161c; text-anchor: middle; }
.scale path { fill: none; stroke: var(--ink); stroke-width: 1.6; }
.scale text { fill: var(--ink); font-size: 13px; text-anchor: middle; }
.plate { fill: var(--ground); opacity: .82; }
figcaption { margin-top: 8px; color: var(--faint); font-size: 14px; }
figcaption b { color: var(--ink); margin-right: 4px; }
.legend { list-style: none; margin: 6px 0 0; padding: 0; display: grid; gap: 3px 22px;
  grid-template-columns: repeat(auto-fill, minmax(250px, 1fr)); font-size: 14px; }
.legend li { display: flex; align-items: center; gap: 8px; min-width: 0; }
.legend svg { flex: none; }
.legend .name { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.legend .faint { margin-left: auto; white-space: nowrap; }
.faint { color: var(--faint); }
.tag { display: inline-block; min-width: 22px; height: 20px; padding: 0 3px; border-radius: 10px; color: #10161c;
  font-size: 12px; line-height: 20px; font-weight: 700; text-align: center; flex: none; }
.label { white-space: nowrap; margin-right: 10px; }
.label .tag { margin-right: 6px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { text-align: left; padding: 6px 12px 6px 0; border-bottom: 1px solid var(--line); white-space: nowrap;
  vertical-align: top; }
th { color: var(--faint); font-weight: 500; font-size: 13px; vertical-align: bottom; }
th:last-child, td:last-child { padding-right: 0; }
.n { text-align: right; font-variant-numeric: tabular-nums; }
.wrap { white-space: normal; line-height: 1.8; }
.pair .label { display: inline-block; max-width: 210px; overflow: hidden; text-overflow: ellipsis;
  vertical-align: bottom; }
.yes { color: var(--yes); } .no { color: var(--no); }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: 22px 20px;
  align-items: end; }
.card > svg { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 6px; }
.card image { image-rendering: pixelated; }
.card figcaption { font-size: 13px; }
.card figcaption span { white-space: nowrap; }
.card figcaption > span { display: block; overflow: hidden; text-overflow: ellipsis; }
.match { fill: none; stroke: #e69f00; stroke-width: 1; }
.loop { fill: #56b4e9; }
.bars { display: grid; grid-template-columns: max-content 1fr max-content max-content; gap: 7px 14px;
  align-items: center; max-width: 820px; font-size: 14px; }
.bar { background: var(--panel); border-radius: 3px; }
.bar i { display: block; height: 14px; border-radius: 3px; background: var(--accent); }
footer { margin-top: 48px; padding-top: 14px; border-top: 1px solid var(--line); color: var(--faint); font-size: 13px; }
@media print { @page { margin: 14mm 12mm; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  body { font-size: 12px; } main { padding: 0; max-width: none; } section { margin-top: 24px; }
  figure, tr, .tile, .bars, .how { break-inside: avoid; } h2, .how { break-after: avoid; }
  .tiles { grid-template-columns: repeat(4, 1fr); gap: 8px; } .tile { padding: 7px 10px; } .tile dd { font-size: 19px; }
  .map > svg { max-height: 118mm; } .map.half { grid-column: auto; }
  .legend { grid-template-columns: repeat(3, 1fr); font-size: 11px; } .cards { grid-template-columns: repeat(4, 1fr); }
  .card figcaption { font-size: 10px; } .scroll { overflow: visible; } table { font-size: 10.5px; }
  th { font-size: 10px; } th, td:not(.n):not(.yes):not(.no) { white-space: normal; }
  th, td { padding: 3px 7px 3px 0; } .pair .label { max-width: 130px; } }
)css";
}

}  // namespace mapweld::report
