// ident: the page's style sheet and its one script.
#pragma once

namespace pushid {

inline constexpr char kPageStyle[] = R"css(
:root{--paper:#fff;--ink:#222;--faint:#666;--line:#ddd;--link:#0b57d0;--box:#f5f6f8;color-scheme:light dark}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--faint:#a0a0a0;--line:#3a3f46;--link:#8ab4f8;--box:#1e2328}}
*{box-sizing:border-box}
body{margin:0 auto;padding:0 1.2rem 4rem;max-width:1240px;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
h1{margin:1.4rem 0 .2rem;font-size:1.7rem}
h2{margin:2.6rem 0 .6rem;font-size:1.25rem;border-bottom:1px solid var(--line);padding-bottom:.2rem}
section{scroll-margin-top:5.5rem}
header p{color:var(--faint);margin:.2rem 0 1rem}
nav{position:sticky;top:0;background:var(--paper);border-bottom:1px solid var(--line);z-index:1}
nav ul{display:flex;flex-wrap:wrap;gap:.1rem 1rem;margin:0;padding:.5rem 0;list-style:none;font-size:.8rem;white-space:nowrap}
a{color:var(--link)}
p{max-width:78ch}
pre{background:var(--box);padding:.5rem .7rem;overflow-x:auto;font-size:.85rem;border-radius:4px}
.panels{display:flex;flex-wrap:wrap;align-items:flex-start}
.scroll{overflow-x:auto}  /* pictures keep their size, so that labels stay readable */
table{border-collapse:collapse;margin:1rem 0;font-size:.8rem;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .6rem .2rem 0;text-align:left;border-bottom:1px solid var(--line);white-space:nowrap}
td:last-child{white-space:normal;min-width:6rem}
th{font-weight:600;white-space:normal;vertical-align:bottom}
.number{text-align:right}
.alarm{border-left:5px solid #c62828;background:var(--box);padding:.5rem .8rem}
figure{margin:1rem 0;break-inside:avoid}
figcaption{color:var(--faint);font-size:.85rem;max-width:78ch}
.panels svg{display:block;flex:none}
@media(max-width:1000px){nav{position:static}section{scroll-margin-top:1rem}table{font-size:.7rem}td{white-space:normal}}
details{border-bottom:1px solid var(--line);padding:.3rem 0}
summary{cursor:pointer}
.moving{width:100%;height:34rem;border:1px solid var(--line);border-radius:4px}
:focus-visible{outline:2px solid var(--link);outline-offset:2px}
@media print{:root{--paper:#fff;--ink:#000;--faint:#444;--line:#bbb;--box:#fff}
nav{display:none}body{max-width:none}h2{break-after:avoid}svg{max-width:100%;height:auto}
pre{white-space:pre-wrap;overflow-wrap:anywhere}.scroll{overflow:visible}summary{break-after:avoid}
table{font-size:.62rem}th,td{white-space:normal;padding-right:.35rem}td:last-child{min-width:0}
svg .paper{fill:#fff}svg .ink,svg .axis{fill:#222}svg .faint{fill:#666}svg line.axis,svg path.axis,svg path.ink{stroke:#222;fill:none}svg line.grid,svg path.grid{stroke:#ddd}}
)css";

// Folds are open on paper.
inline constexpr char kPageScript[] = R"js(
(function () {
  let closed = [];
  addEventListener('beforeprint', () => {
    closed = [...document.querySelectorAll('details:not([open])')];
    for (const fold of closed) fold.open = true;
  });
  addEventListener('afterprint', () => {
    for (const fold of closed) fold.open = false;
  });
})();
)js";

}  // namespace pushid
