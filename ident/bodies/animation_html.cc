// ident: the page that shows an animation. Positions are whole millimetres, forces whole newtons.
#include <cmath>
#include <nlohmann/json.hpp>

#include "ident/bodies/animation.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr char kHead[] = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>)html";

constexpr char kBody[] = R"html(</title>
<style>
:root{--paper:#fff;--ink:#222;--grid:#ddd;--recorded:#8a8a8a}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--grid:#3a3f46;--recorded:#a0a0a0}}
body{margin:0;background:var(--paper);color:var(--ink);font:14px system-ui,sans-serif;display:flex;flex-direction:column;height:100vh}
header,footer{padding:8px 14px;display:flex;gap:14px;align-items:center;flex-wrap:wrap}
h1{font-size:15px;margin:0 auto 0 0}canvas{flex:1;min-height:0;width:100%;touch-action:none;cursor:grab}
input[type=range]{flex:1;min-width:160px}button{font:inherit;padding:4px 12px;min-width:70px}
output{font-variant-numeric:tabular-nums;min-width:9em}label{white-space:nowrap}
</style></head><body>
<header><h1 id="title"></h1>
<label><input type="checkbox" id="recorded" checked> recorded (grey)</label>
<label><input type="checkbox" id="predicted" checked> predicted (colour)</label>
<label><input type="checkbox" id="pendulums" checked> pendulums</label>
<label><input type="checkbox" id="forces" checked> net forces (1 m = 1000 N)</label></header>
<canvas id="view" aria-label="People in motion; drag to turn, wheel to zoom"></canvas>
<footer><button id="play">Play</button>
<input type="range" id="time" min="0" value="0" step="1" aria-label="time">
<output id="clock"></output>
<label>speed <select id="speed"><option value="0.25">1/4</option><option value="0.5">1/2</option>
<option value="1" selected>1</option></select></label></footer>
<script>
const data=)html";

constexpr char kScript[] = R"html(;
const $=id=>document.getElementById(id),view=$('view'),pen=view.getContext('2d');
const parents=[-1,0,1,2,3,4,3,6,7,8,3,10,11,12,0,14,15,16,0,18,19,20];
const colours=['#2a78c8','#d1691f','#2f9e57','#9b59b6','#c0392b','#16a085','#b8860b','#6c5ce7'];
let frame=0,playing=false,turn=-0.6,tilt=0.25,zoom=1,last=0,centre=[0,0,900],size=1500;
$('title').textContent=data.title;$('time').max=data.frames-1;
(function extent(){let lo=[1e9,1e9],hi=[-1e9,-1e9];
 for(const p of data.people){const s=p.body.length?p.body:p.tip;for(const f of s)for(let i=0;i<f.length;i+=3)
  for(let k=0;k<2;k++){lo[k]=Math.min(lo[k],f[i+k]);hi[k]=Math.max(hi[k],f[i+k]);}}
 if(lo[0]<hi[0]||lo[0]===hi[0]){centre=[(lo[0]+hi[0])/2,(lo[1]+hi[1])/2,900];size=Math.max(1300,Math.hypot(hi[0]-lo[0],hi[1]-lo[1])/1.7+500);}})();
function project(x,y,z){x-=centre[0];y-=centre[1];z-=centre[2];
 const c=Math.cos(turn),s=Math.sin(turn),a=c*x-s*y,b=s*x+c*y,e=Math.cos(tilt),g=Math.sin(tilt);
 const depth=e*b-g*z+4*size,k=zoom*4*size/Math.max(depth,size*0.2)*Math.min(view.width,view.height*1.6)/(2.3*size);
 return [view.width/2+k*a,view.height/2-k*(g*b+e*z),k];}
function line(a,b,colour,width,dash){const p=project(...a),q=project(...b);pen.strokeStyle=colour;
 pen.lineWidth=Math.max(1,width*(p[2]+q[2])/2);pen.setLineDash(dash||[]);pen.beginPath();pen.moveTo(p[0],p[1]);pen.lineTo(q[0],q[1]);pen.stroke();}
function dot(a,r,colour){const p=project(...a);pen.fillStyle=colour;pen.beginPath();pen.arc(p[0],p[1],Math.max(2,r*p[2]),0,7);pen.fill();}
const at=(f,j)=>[f[3*j],f[3*j+1],f[3*j+2]];
function style(name){return getComputedStyle(document.documentElement).getPropertyValue(name);}
function floor(){const grid=style('--grid'),step=500,n=Math.ceil(size/step)+1,cx=Math.round(centre[0]/step)*step,cy=Math.round(centre[1]/step)*step;
 for(let i=-n;i<=n;i++){line([cx+i*step,cy-n*step,0],[cx+i*step,cy+n*step,0],grid,0.5);line([cx-n*step,cy+i*step,0],[cx+n*step,cy+i*step,0],grid,0.5);}}
function body(f,colour){for(let j=1;j<22;j++)line(at(f,parents[j]),at(f,j),colour,28);dot(at(f,5),95,colour);}
function draw(){const d=devicePixelRatio||1;view.width=view.clientWidth*d;view.height=view.clientHeight*d;
 pen.lineCap='round';pen.clearRect(0,0,view.width,view.height);floor();
 let number=0;
 for(const p of data.people){const f=Math.min(frame,Math.max(p.body.length,p.tip.length)-1);
  const colour=p.recorded?style('--recorded'):colours[number++%colours.length];
  if(p.recorded?!$('recorded').checked:!$('predicted').checked)continue;
  if(p.body.length){pen.globalAlpha=p.recorded?0.55:1;body(p.body[f],colour);pen.globalAlpha=1;}
  if(p.tip.length&&$('pendulums').checked){line(p.cart[f],p.tip[f],'#d1495b',12,[8,6]);dot(p.cart[f],35,'#d1495b');dot(p.tip[f],45,'#d1495b');}
  if(p.force.length&&$('forces').checked){const t=p.tip[f],F=p.force[f];if(Math.hypot(F[0],F[1])>=5){
   const end=[t[0]+F[0],t[1]+F[1],t[2]];line(t,end,'#e0a100',22);dot(end,40,'#e0a100');}}}
 $('clock').textContent=(frame*data.dt).toFixed(2)+' s, frame '+frame;$('time').value=frame;}
function tick(now){if(!playing)return;const steps=(now-last)/1000/data.dt*$('speed').value;
 if(steps>=1){frame+=Math.floor(steps);last=now;if(frame>=data.frames)frame=0;draw();}requestAnimationFrame(tick);}
function play(on){playing=on;$('play').textContent=on?'Pause':'Play';if(on){last=performance.now();if(frame>=data.frames-1)frame=0;requestAnimationFrame(tick);}}
$('play').onclick=()=>play(!playing);$('time').oninput=e=>{play(false);frame=+e.target.value;draw();};
for(const id of ['recorded','predicted','pendulums','forces'])$(id).onchange=draw;
view.onpointerdown=e=>{view.setPointerCapture(e.pointerId);view.onpointermove=m=>{turn+=m.movementX*0.008;
 tilt=Math.min(1.5,Math.max(-0.1,tilt+m.movementY*0.006));draw();};};
view.onpointerup=view.onpointercancel=()=>{view.onpointermove=null;};
view.onwheel=e=>{e.preventDefault();zoom=Math.min(8,Math.max(0.3,zoom*Math.exp(-e.deltaY*0.001)));draw();};
onkeydown=e=>{if(e.key===' '&&e.target.tagName!=='BUTTON'){e.preventDefault();play(!playing);}
 const step={ArrowLeft:-1,ArrowRight:1}[e.key];if(step&&e.target.id!=='time'){play(false);frame=Math.min(data.frames-1,Math.max(0,frame+step));draw();}};
const wanted=new URLSearchParams(location.search).get('frame')||location.hash.slice(1);
if(wanted)frame=Math.min(data.frames-1,Math.max(0,+wanted||0));
onresize=draw;draw();
</script></body></html>
)html";

int Whole(double value) { return static_cast<int>(std::lround(value)); }

nlohmann::json Millimetres(const std::vector<Vector3<double>>& points) {
  nlohmann::json json = nlohmann::json::array();
  for (const auto& p : points) {
    json.push_back({Whole(1000 * p.x()), Whole(1000 * p.y()), Whole(1000 * p.z())});
  }
  return json;
}

nlohmann::json PersonJson(const AnimatedPerson& person) {
  nlohmann::json body = nlohmann::json::array(), force = nlohmann::json::array();
  for (const Pose& pose : person.body) {
    nlohmann::json numbers = nlohmann::json::array();
    for (Eigen::Index i = 0; i < pose.size(); ++i) numbers.push_back(Whole(1000 * pose.data()[i]));
    body.push_back(std::move(numbers));
  }
  for (const auto& f : person.force) force.push_back({Whole(f[0]), Whole(f[1])});
  return {{"name", person.name},
          {"recorded", person.recorded},
          {"body", std::move(body)},
          {"cart", Millimetres(person.cart)},
          {"tip", Millimetres(person.tip)},
          {"force", std::move(force)}};
}

// A "</script>" within a text must not end the script.
std::string ForScript(std::string json) {
  for (size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3) {
    json.replace(at, 2, "<\\/");
  }
  return json;
}

}  // namespace

std::string AnimationHtml(const Animation& animation) {
  nlohmann::json data = {{"title", animation.title},
                         {"dt", animation.dt},
                         {"frames", animation.num_frames()},
                         {"people", nlohmann::json::array()}};
  for (const AnimatedPerson& person : animation.people)
    data["people"].push_back(PersonJson(person));
  return kHead + EscapeXml(animation.title) + kBody +
         ForScript(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) + kScript;
}

}  // namespace pushid
