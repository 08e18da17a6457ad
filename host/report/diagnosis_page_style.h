// How the page of a diagnosis looks: on a bright screen, on a dark one and on paper.
#pragma once

namespace mcdem {

inline constexpr const char* diagnosis_page_style = R"(
:root { color-scheme: light dark; --ink: #1c1f23; --soft: #5a626b; --axis: #5a626b; --grid: #dcdfe3;
  --back: #ffffff; --card: #f5f6f8; --line: #d5d9de; --mark: #b34700; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e8eb; --soft: #a3abb4; --axis: #a3abb4; --grid: #3b4148; --back: #16181b; --card: #1f2226;
    --line: #3b4148; --mark: #ff9a52; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 66rem; margin: 0 auto; padding: 1.5rem 1.25rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 0.5rem; }
h2 { font-size: 1.3rem; margin: 3rem 0 0.75rem; padding-top: 1rem; border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 1.75rem 0 0.5rem; }
p { max-width: 46rem; margin: 0.5rem 0; }
.kicker { margin: 0 0 0.25rem; color: var(--soft); }
.lead { font-size: 1.15rem; max-width: 50rem; }
.note, figcaption { color: var(--soft); font-size: 0.9rem; }
dl { background: var(--card); border-radius: 0.5rem; padding: 1rem 1.25rem; margin: 1.5rem 0;
  display: grid; grid-template-columns: max-content 1fr; gap: 0.6rem 1.25rem; }
dt { font-weight: 600; color: var(--mark); }
dd { margin: 0; overflow-wrap: anywhere; }
figure { margin: 1rem 0; }
figure > div, .wide { overflow-x: auto; }
figcaption { max-width: 50rem; margin-top: 0.5rem; }
svg { display: block; width: 100%; min-width: 44rem; height: auto; font-family: system-ui, sans-serif; }
table { border-collapse: collapse; font-size: 0.9rem; margin: 0.5rem 0; font-variant-numeric: tabular-nums; }
th, td { padding: 0.3rem 0.9rem 0.3rem 0; text-align: right; vertical-align: top; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); vertical-align: bottom; }
td { overflow-wrap: break-word; }
td:first-child { white-space: nowrap; }
.left { text-align: left; }
ul { padding-left: 1.2rem; max-width: 50rem; }
li { margin: 0.3rem 0; overflow-wrap: anywhere; }
@media (max-width: 40rem) { dl { grid-template-columns: 1fr; gap: 0.1rem; } dd { margin-bottom: 0.6rem; } }
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --axis: #444; --grid: #ccc; --back: #fff; --card: #fff;
    --line: #bbb; --mark: #000; }
  @page { margin: 15mm; }
  body { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  dl { border: 1px solid var(--line); }
  svg { min-width: 0; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  figure, tr, li, dl { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  figure > div, .wide { overflow: visible; }
}
)";

}  // namespace mcdem
