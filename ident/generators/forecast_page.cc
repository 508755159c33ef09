// ident: the page that shows a forecast. Positions are whole millimetres.
#include <cmath>
#include <nlohmann/json.hpp>

#include "ident/figures/svg.h"
#include "ident/generators/forecast_scene.h"

namespace pushid {
namespace {

constexpr char kHead[] = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>)html";

constexpr char kBody[] = R"html(</title>
<style>
:root{--paper:#fff;--ink:#222;--recorded:#777;--forecast:#1f6fc0;--future:#5fa3e0}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--recorded:#aaa;--forecast:#6db3ff;--future:#3f7fc0}}
body{margin:0;background:var(--paper);color:var(--ink);font:14px system-ui,sans-serif;display:flex;flex-direction:column;height:100vh}
header,footer{padding:8px 14px;display:flex;gap:14px;align-items:center;flex-wrap:wrap}
h1{font-size:15px;margin:0 auto 0 0}canvas{flex:1;min-height:0;width:100%;touch-action:none;cursor:grab}
input[type=range]{flex:1;min-width:160px}button{font:inherit;padding:4px 12px;min-width:70px}
output{font-variant-numeric:tabular-nums;min-width:11em}label{white-space:nowrap}
</style></head><body>
<header><h1 id="title"></h1>
<label><input type="checkbox" id="recorded" checked> recorded (grey)</label>
<label><input type="checkbox" id="forecast" checked> forecast (blue)</label>
<label><input type="checkbox" id="futures" checked> sampled futures (faint)</label>
<label><input type="checkbox" id="trails" checked> paths of hands and feet</label></header>
<canvas id="view" aria-label="A forecast over the recorded motion; drag to turn, wheel to zoom"></canvas>
<footer><button id="play">Play</button>
<input type="range" id="time" min="0" value="0" step="1" aria-label="time"><output id="clock"></output></footer>
<script>
const data=)html";

constexpr char kScript[] = R"html(;
const $=id=>document.getElementById(id),view=$('view'),pen=view.getContext('2d');
let frame=data.observed-1,playing=false,turn=0.7,tilt=0.15,zoom=1,last=0;
$('title').textContent=data.title;$('time').max=data.frames-1;
const lo=[1e9,1e9,1e9],hi=[-1e9,-1e9,-1e9];
for(const f of data.observed_motion.concat(data.forecast))for(let i=0;i<f.length;i++){lo[i%3]=Math.min(lo[i%3],f[i]);hi[i%3]=Math.max(hi[i%3],f[i]);}
const up=data.up,a=(up+1)%3,b=(up+2)%3,centre=lo.map((l,i)=>(l+hi[i])/2),size=Math.max(...hi.map((h,i)=>h-lo[i]))*1.25;
function project(p){const x=p[a]-centre[a],y=p[b]-centre[b],z=p[up]-centre[up],c=Math.cos(turn),s=Math.sin(turn);
 const k=zoom*Math.min(view.width,view.height)/size,d=s*x+c*y;
 return [view.width/2+k*(c*x-s*y),view.height/2-k*(Math.cos(tilt)*z+Math.sin(tilt)*d)];}
function style(name){return getComputedStyle(document.documentElement).getPropertyValue(name);}
function line(p,q){const u=project(p),v=project(q);pen.beginPath();pen.moveTo(...u);pen.lineTo(...v);pen.stroke();}
const at=(f,j)=>f.slice(3*j,3*j+3);
function body(f,colour,width,alpha){if(!f)return;pen.strokeStyle=colour;pen.lineWidth=width;pen.globalAlpha=alpha;
 data.parents.forEach((p,j)=>{if(p===-2)return;line(p===-1?data.fixed[j]:at(f,p),at(f,j));});pen.globalAlpha=1;}
function trail(motion,until,colour,alpha){pen.strokeStyle=colour;pen.lineWidth=1.5;pen.globalAlpha=alpha;
 for(const j of data.ends){let before=at(data.observed_motion[data.observed-1],j);
  for(let t=0;t<=until&&t<motion.length;t++){const here=at(motion[t],j);line(before,here);before=here;}}pen.globalAlpha=1;}
function draw(){const d=devicePixelRatio||1;view.width=view.clientWidth*d;view.height=view.clientHeight*d;
 pen.lineCap='round';pen.clearRect(0,0,view.width,view.height);const t=frame-data.observed;
 if($('futures').checked)for(const f of data.futures){body(f[t],style('--future'),d,0.3);if($('trails').checked)trail(f,t,style('--future'),0.5);}
 if($('recorded').checked){body(t<0?data.observed_motion[frame]:data.recorded[t],style('--recorded'),4*d,0.8);if($('trails').checked)trail(data.recorded,t,style('--recorded'),1);}
 if($('forecast').checked){body(data.forecast[t],style('--forecast'),3*d,1);if($('trails').checked)trail(data.forecast,t,style('--forecast'),1);}
 $('clock').textContent=((t+1)*data.dt).toFixed(2)+' s, '+(t<0?'observed':'forecast');$('time').value=frame;}
function tick(now){if(!playing)return;const steps=(now-last)/1000/data.dt;
 if(steps>=1){frame+=Math.floor(steps);last=now;if(frame>=data.frames)frame=0;draw();}requestAnimationFrame(tick);}
function play(on){playing=on;$('play').textContent=on?'Pause':'Play';if(on){last=performance.now();requestAnimationFrame(tick);}}
$('play').onclick=()=>play(!playing);$('time').oninput=e=>{play(false);frame=+e.target.value;draw();};
for(const id of ['recorded','forecast','futures','trails'])$(id).onchange=draw;
view.onpointerdown=e=>{view.setPointerCapture(e.pointerId);view.onpointermove=m=>{turn+=m.movementX*0.008;
 tilt=Math.min(1.5,Math.max(-0.2,tilt+m.movementY*0.006));draw();};};
view.onpointerup=view.onpointercancel=()=>{view.onpointermove=null;};
view.onwheel=e=>{e.preventDefault();zoom=Math.min(8,Math.max(0.3,zoom*Math.exp(-e.deltaY*0.001)));draw();};
const wanted=location.hash.slice(1);if(wanted)frame=Math.min(data.frames-1,Math.max(0,+wanted||0));
onresize=draw;draw();
</script></body></html>
)html";

nlohmann::json Frames(const Trajectories& motion) {
  nlohmann::json frames = nlohmann::json::array();
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    nlohmann::json numbers = nlohmann::json::array();
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
      numbers.push_back(std::lround(1000.0f * motion(i, t)));
    }
    frames.push_back(std::move(numbers));
  }
  return frames;
}

// What ends a limb: nothing hangs on it.
std::vector<int> Ends(const ParticleLayout& layout) {
  std::vector<int> ends;
  for (int i = 0; i < layout.num_particles(); ++i) {
    bool is_end = true;
    for (int parent : layout.parents) is_end = is_end && parent != i;
    if (is_end) ends.push_back(i);
  }
  return ends;
}

// A "</script>" within a text must not end the script.
std::string ForScript(std::string json) {
  for (size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3) {
    json.replace(at, 2, "<\\/");
  }
  return json;
}

}  // namespace

std::string ForecastPageHtml(const ForecastScene& scene) {
  nlohmann::json data = {{"title", scene.title},
                         {"dt", scene.dt},
                         {"observed", scene.num_observed()},
                         {"frames", scene.num_frames()},
                         {"up", scene.layout.up_axis},
                         {"parents", scene.layout.parents},
                         {"ends", Ends(scene.layout)},
                         {"observed_motion", Frames(scene.observed)},
                         {"recorded", Frames(scene.recorded)},
                         {"forecast", Frames(scene.forecast)},
                         {"fixed", nlohmann::json::array()},
                         {"futures", nlohmann::json::array()}};
  for (Eigen::Index i = 0; i < scene.layout.fixed.cols(); ++i) {
    const Eigen::Vector3f place = 1000.0f * scene.layout.fixed.col(i);
    data["fixed"].push_back(
        {std::lround(place.x()), std::lround(place.y()), std::lround(place.z())});
  }
  for (const SampledFuture& future : scene.futures) {
    data["futures"].push_back(Frames(future.motion));
  }
  return kHead + EscapeXml(scene.title) + kBody +
         ForScript(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) + kScript;
}

}  // namespace pushid
