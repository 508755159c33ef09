#include "ident/figures/moving_page.h"

#include <nlohmann/json.hpp>

#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr char kHead[] = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>)html";

constexpr char kMovingPageStyle[] =
    R"html(body{margin:0;background:var(--paper);color:var(--ink);font:14px system-ui,sans-serif;display:flex;flex-direction:column;min-height:100vh;height:100vh}
header,footer{padding:8px 14px;display:flex;gap:14px;align-items:center;flex-wrap:wrap}
h1{font-size:15px;margin:0 auto 0 0}canvas{flex:1;min-height:0;width:100%;touch-action:none;cursor:grab}
.moment{min-width:0;margin:2px 0}.moment[aria-current=true]{outline:3px solid var(--push,#d55e00)}
input[type=range]{flex:1;min-width:160px}button{font:inherit;padding:4px 12px;min-width:70px}
.chip{display:inline-block;width:1.1em;height:.6em;margin:0 .2em}
@media print{footer{display:none}body{display:block;height:auto;min-height:0}canvas{height:auto}}
output{font-variant-numeric:tabular-nums;min-width:11em}label{white-space:nowrap}
</style></head><body>
<header><h1 id="title"></h1>
)html";

constexpr char kFooter[] =
    R"html(; drag to turn, wheel (within a page: with Ctrl) to zoom"></canvas>
<footer><button id="play">Play</button>
<input type="range" id="time" min="0" value="0" step="1" aria-label="time">
<output id="clock"></output>
<label>speed <select id="speed"><option value="0.25">1/4</option><option value="0.5">1/2</option>
<option value="1" selected>1</option></select></label></footer>
)html";

constexpr char kScriptBefore[] = R"html(;
let data=all[0];
const $=id=>document.getElementById(id),view=$('view'),pen=view.getContext('2d'),framed=parent!==window;
function style(name){return getComputedStyle(document.documentElement).getPropertyValue(name);}
)html";

constexpr char kScriptAfter[] = R"html(let playing=false,last=0;
function tick(now){if(!playing)return;const steps=(now-last)/1000/data.dt*$('speed').value;
 if(steps>=1){frame+=Math.floor(steps);last=now;if(frame>=data.frames)frame=0;draw();}requestAnimationFrame(tick);}
function play(on){playing=on;$('play').textContent=on?'Pause':'Play';if(on){last=performance.now();if(frame>=data.frames-1)frame=0;requestAnimationFrame(tick);}}
$('play').onclick=()=>play(!playing);$('time').oninput=e=>{play(false);frame=+e.target.value;draw();};
for(const box of document.querySelectorAll('input[type=checkbox]'))box.onchange=draw;
view.onpointerdown=e=>{view.setPointerCapture(e.pointerId);view.onpointermove=m=>{turn+=m.movementX*0.008;
 tilt=Math.min(1.5,Math.max(-0.1,tilt+m.movementY*0.006));draw();};};
view.onpointerup=view.onpointercancel=()=>{view.onpointermove=null;};
if(framed)view.style.touchAction='pan-y'; // what is around it scrolls
view.onwheel=e=>{if(framed&&!e.ctrlKey)return;e.preventDefault();zoom=Math.min(8,Math.max(0.3,zoom*Math.exp(-e.deltaY*0.001)));draw();};
onkeydown=e=>{if(e.key===' '&&e.target.tagName!=='BUTTON'){e.preventDefault();play(!playing);}
 const step={ArrowLeft:-1,ArrowRight:1}[e.key];if(step&&e.target.id!=='time'){play(false);frame=Math.min(data.frames-1,Math.max(0,frame+step));draw();}};
function choose(which){data=all[which];$('title').textContent=data.title;$('time').max=data.frames-1;frame=0;open();}
if(all.length>1){const list=document.createElement('select');list.id='recording';list.setAttribute('aria-label','recording');
 all.forEach((one,i)=>list.add(new Option(one.title,i)));list.onchange=()=>{play(false);choose(list.value);draw();};
 $('title').before(list);$('title').hidden=true;}
choose(0);
const wanted=new URLSearchParams(location.search).get('frame')||location.hash.slice(1);
if(wanted)frame=Math.min(data.frames-1,Math.max(0,+wanted||0));
onresize=draw;draw();
</script></body></html>
)html";

// A "</script>" within a text must not end the script.
std::string ForScript(std::string json) {
  for (size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3) {
    json.replace(at, 2, "<\\/");
  }
  return json;
}

// The motion fills most of the window; the page is longer than that.
std::string FiguresHtml(const std::vector<std::string>& figures) {
  if (figures.empty()) return "";
  std::string html = "<style>body{height:auto}canvas{flex:none;height:80vh}" +
                     std::string(SvgStyle()) + "</style>\n<section>\n";
  for (const std::string& figure : figures) html += figure + "\n";
  return html + "</section>\n";
}

}  // namespace

std::string ToHtml(const MovingPage& page) {
  return kHead + EscapeXml(page.data.at(0).at("title").get<std::string>()) +
         "</title>\n<style>\n:root{--paper:#fff;--ink:#222;" + page.light +
         "}\n@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;" + page.dark +
         "}}\n" + kMovingPageStyle + page.choices + "</header>\n<canvas id=\"view\" aria-label=\"" +
         page.described + kFooter + FiguresHtml(page.figures) + "<script>\nconst all=" +
         ForScript(page.data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) +
         kScriptBefore + page.script + kScriptAfter;
}

}  // namespace pushid
