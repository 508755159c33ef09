#include "ident/bodies/animation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kBrightest = 0.85;  // of the scale of colours, that is seen on paper

constexpr char kHead[] = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>)html";

constexpr char kStyle[] =
    R"html(</title>
<style>
:root{--paper:#fff;--ink:#222;--push:#d55e00;--grid:#ddd;--recorded:#8a8a8a}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--push:#d55e00;--grid:#3a3f46;--recorded:#a0a0a0}}
body{margin:0;background:var(--paper);color:var(--ink);font:14px system-ui,sans-serif;display:flex;flex-direction:column;min-height:100vh;height:100vh}
header,footer{padding:8px 14px;display:flex;gap:14px;align-items:center;flex-wrap:wrap}
h1{font-size:15px;margin:0 auto 0 0}canvas{flex:1;min-height:0;width:100%;touch-action:none;cursor:grab}
input[type=range]{flex:1;min-width:160px}button{font:inherit;padding:4px 12px;min-width:70px}
.chip{display:inline-block;width:1.1em;height:.6em;margin:0 .2em}
@media print{footer{display:none}body{display:block;height:auto;min-height:0}canvas{height:auto}}
output{font-variant-numeric:tabular-nums;min-width:11em}label{white-space:nowrap}
</style></head><body>
<header><h1 id="title"></h1>
)html";

constexpr char kCanvas[] =
    R"html(</header>
<canvas id="view" aria-label="People in motion; drag to turn, wheel (within a page: with Ctrl) to zoom"></canvas>
<footer><button id="play">Play</button>
<input type="range" id="time" min="0" value="0" step="1" aria-label="time">
<output id="clock"></output>
<label>speed <select id="speed"><option value="0.25">1/4</option><option value="0.5">1/2</option>
<option value="1" selected>1</option></select></label></footer>
)html";

constexpr char kScript[] = R"html(;
let data=all[0];
const $=id=>document.getElementById(id),view=$('view'),pen=view.getContext('2d'),framed=parent!==window;
function style(name){return getComputedStyle(document.documentElement).getPropertyValue(name);}
let frame=0,turn=-0.6,tilt=0.25,zoom=1,names,pushed,bodies,centre,size,origin,span;
const on=id=>!$(id)||$(id).checked,at=(f,j)=>[f[3*j],f[3*j+1],f[3*j+2]];
// Samples lie data.every frames apart; positions between them are interpolated.
function now(list){const k=Math.min(frame/data.every,list.length-1),i=Math.floor(k),a=list[i];
 return i===k?a:a.map((v,n)=>v+(k-i)*(list[i+1][n]-v));}
const hip=p=>p.tip.length?now(p.tip):at(now(p.body),0);
function open(){let lo=[1e9,1e9],hi=[-1e9,-1e9];
 if(!data.summed)for(const p of data.people)for(const s of [p.body,p.cart,p.tip])for(let t=1;t<s.length;t++)s[t]=s[t].map((v,i)=>v+s[t-1][i]);
 data.summed=true;names=[...new Set(data.people.map(p=>p.name))];pushed=new Set(data.pushes.map(p=>p.person));
 bodies=data.people.some(p=>p.body.length);centre=[0,0,900];size=1500;origin=[0,0];span=[1,1];
 for(const p of data.people){const s=p.body.length?p.body:p.tip;for(const f of s)for(let i=0;i<f.length;i+=3)
  for(let k=0;k<2;k++){lo[k]=Math.min(lo[k],f[i+k]);hi[k]=Math.max(hi[k],f[i+k]);}}
 if(lo[0]>hi[0])return;
 centre=[(lo[0]+hi[0])/2,(lo[1]+hi[1])/2,900];size=Math.max(1600,Math.hypot(hi[0]-lo[0],hi[1]-lo[1])/1.7+500);
 span=[hi[0]-lo[0]+300,hi[1]-lo[1]+300];origin=hip(data.people.find(p=>pushed.has(p.name))||data.people[0]);}
function project(x,y,z){x-=centre[0];y-=centre[1];z-=centre[2];
 const c=Math.cos(turn),s=Math.sin(turn),a=c*x-s*y,b=s*x+c*y,e=Math.cos(tilt),g=Math.sin(tilt);
 const depth=e*b-g*z+4*size,k=zoom*4*size/Math.max(depth,size*0.2)*Math.min(view.width,view.height*1.6)/(2.3*size);
 return [view.width/2+k*a,view.height/2-k*(g*b+e*z),k];}
function line(a,b,colour,width,dash){const p=project(...a),q=project(...b);pen.strokeStyle=colour;
 pen.lineWidth=Math.max(1,width*(p[2]+q[2])/2);pen.setLineDash(dash||[]);pen.beginPath();pen.moveTo(p[0],p[1]);pen.lineTo(q[0],q[1]);pen.stroke();}
function dot(a,r,colour){const p=project(...a);pen.fillStyle=colour;pen.beginPath();pen.arc(p[0],p[1],Math.max(2,r*p[2]),0,7);pen.fill();}
function words(text,x,y,colour,bold){pen.font=(bold?'600 ':'')+13*(devicePixelRatio||1)+'px system-ui,sans-serif';
 pen.textAlign='center';pen.fillStyle=colour;pen.fillText(text,x,y);}
// Lines every half metre from where the pushed person starts; whole metres have their number.
function floor(){const grid=style('--grid'),step=500,n=Math.ceil(size/step)+1;
 const cx=origin[0]+Math.round((centre[0]-origin[0])/step)*step,cy=origin[1]+Math.round((centre[1]-origin[1])/step)*step;
 for(let i=-n;i<=n;i++){line([cx+i*step,cy-n*step,0],[cx+i*step,cy+n*step,0],grid,0.5);line([cx-n*step,cy+i*step,0],[cx+n*step,cy+i*step,0],grid,0.5);}
 const d=devicePixelRatio||1,front=Math.min(origin[1],centre[1]-span[1]/2)-100;
 for(let i=-n;i<=n;i++){const m=Math.round((cx-origin[0])/step)+i;if(m%2)continue;
  const p=project(origin[0]+m*step,front,0);words(String(m/2).replace('-','\u2212')+' m',p[0],p[1]+14*d,style('--ink'));}}
function body(p,colour){const f=now(p.body);p.parents.forEach((a,j)=>{if(a>=0)line(at(f,a),at(f,j),colour,28);});
 if(p.head>=0)dot(at(f,p.head),95,colour);}
// A foot on the ground, which fades when it leaves; with the time at which it landed.
function sole(p,[x,y,from,to]){if(frame<from)return;const c=Math.cos(p.facing),s=Math.sin(p.facing);pen.beginPath();
 for(let i=0;i<24;i++){const a=i*Math.PI/12,u=data.sole[0]+data.sole[1]*Math.cos(a),v=45*Math.sin(a),q=project(x+c*u-s*v,y+s*u+c*v,0);pen.lineTo(q[0],q[1]);}
 pen.globalAlpha=frame<to?0.6:0.2;pen.fillStyle=colourOf(p);pen.fill();pen.globalAlpha=1;
 const q=project(x+c*data.sole[0],y+s*data.sole[0],0);if(from&&!p.recorded)words((from*data.dt).toFixed(2)+' s',q[0],q[1]+4*(devicePixelRatio||1),style('--ink'));}
// Ends where it meets the hip.
function arrow(hip,force){const n=Math.hypot(...force);if(n<5)return;const c=style('--push'),d=devicePixelRatio||1;
 const tail=[hip[0]-force[0],hip[1]-force[1],hip[2]],u=[force[0]/n,force[1]/n];line(tail,hip,c,30);
 for(const s of [1,-1])line(hip,[hip[0]-110*u[0]-s*60*u[1],hip[1]-110*u[1]+s*60*u[0],hip[2]],c,30);
 const p=project(...tail);words(Math.round(n)+' N',p[0],p[1]-16*d,c,true);}
// A name over its person, raised until it covers no other, or lowered where there is no room above.
function nameAt(name,x,y,labels){const d=devicePixelRatio||1,h=15*d;words('',0,0,style('--ink'));
 const w=pen.measureText(name).width+6*d;y=Math.max(16*d,y);
 const covers=l=>Math.abs(l.x-x)<(l.w+w)/2&&Math.abs(l.y-y)<h;
 const above=y;for(let i=0;i<12&&y>h+16*d&&labels.some(covers);i++)y-=h;
 if(labels.some(covers))for(y=above;labels.some(covers);)y+=h;
 labels.push({x,y,w});words(name,x,y,style('--ink'));}
function ring(p,r,colour){pen.strokeStyle=colour;pen.setLineDash([]);pen.lineWidth=2.5*(devicePixelRatio||1);pen.beginPath();pen.arc(p[0],p[1],r,0,7);pen.stroke();}
function colourOf(p){return p.recorded?style('--recorded'):data.colours[(data.whats.length>1?p.what:names.indexOf(p.name))%data.colours.length];}
const shown=p=>p.recorded?on('recorded'):on('predicted')&&on('what'+p.what);
// Groups from above, the first metre to the right.
function inset(){if(names.length<2||!on('above'))return;const d=devicePixelRatio||1,w=Math.min(230*d,view.width*0.4),h=130*d,x0=view.width-w-8*d,y0=8*d;
 pen.globalAlpha=0.85;pen.fillStyle=style('--paper');pen.fillRect(x0,y0,w,h);pen.globalAlpha=1;pen.setLineDash([]);pen.lineWidth=d;pen.strokeStyle=style('--grid');pen.strokeRect(x0,y0,w,h);
 const k=Math.min((w-20*d)/span[0],(h-34*d)/span[1]),place=q=>[x0+w/2+k*(q[0]-centre[0]),y0+h/2+8*d-k*(q[1]-centre[1])];
 words('from above',x0+42*d,y0+16*d,style('--ink'));
 for(const p of data.people){if(!shown(p))continue;const q=place(hip(p));pen.fillStyle=colourOf(p);pen.beginPath();pen.arc(q[0],q[1],4*d,0,7);pen.fill();
  if(pushed.has(p.name))ring(q,7*d,style('--push'));}}
function draw(){const d=devicePixelRatio||1;view.width=view.clientWidth*d;view.height=view.clientHeight*d;
 pen.lineCap='round';pen.clearRect(0,0,view.width,view.height);floor();
 const hips=new Map(),labels=[];
 if(on('footprints'))for(const p of data.people)if(shown(p))for(const print of p.footprints)sole(p,print);
 for(const p of data.people){const colour=colourOf(p);
  if(!shown(p))continue;
  hips.set(p.name,hip(p));
  if(p.body.length){pen.globalAlpha=p.recorded?0.55:1;body(p,colour);pen.globalAlpha=1;}
  const rod=p.recorded||data.whats.length>1||names.length>1?colour:'#d1495b';
  if(p.tip.length&&on('pendulums')){const c=now(p.cart),t=now(p.tip);line(c,t,rod,12,[8,6]);dot(c,35,rod);dot(t,45,rod);}
  if(p.force.length&&on('forces')){const t=now(p.tip),F=now(p.force);if(Math.hypot(F[0],F[1])>=5){
   const end=[t[0]+F[0],t[1]+F[1],t[2]];line(t,end,'#e0a100',22);dot(end,40,'#e0a100');}}}
 for(const [name,h] of hips){const p=project(...h);
  if(pushed.has(name))ring(p,Math.max(8*d,90*p[2]),style('--push'));
  if(on('names')){const top=project(h[0],h[1],h[2]+(bodies?900:250));nameAt(name,top[0],top[1]-6*d,labels);}}
 for(const p of data.pushes){const F=p.force[frame-p.start],h=hips.get(p.person);if(F&&h)arrow(h,F);}
 inset();
 $('clock').textContent=(frame*data.dt).toFixed(2)+' s, frame '+frame;$('time').value=frame;}
let playing=false,last=0;
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

std::string Chip(const std::string& colour) {
  return "<span class=\"chip\" style=\"background:" + colour + "\"></span>";
}

std::string Box(const std::string& id, const std::string& text, const std::string& colour = "") {
  return "<label><input type=\"checkbox\" id=\"" + id + "\" checked>" +
         (colour.empty() ? "" : Chip(colour)) + " " + EscapeXml(text) + "</label>\n";
}

std::set<std::string> NamesOf(const Animation& animation) {
  std::set<std::string> names;
  for (const AnimatedPerson& person : animation.people) names.insert(person.name);
  return names;
}

template <typename Has>
bool AnyPerson(const Animation& animation, Has has) {
  return std::any_of(animation.people.begin(), animation.people.end(), has);
}
bool IsRecorded(const AnimatedPerson& person) { return person.recorded; }
bool HasForce(const AnimatedPerson& person) { return !person.force.empty(); }

// Check boxes of what the animations contain.
std::string Choices(const std::vector<Animation>& animations) {
  const auto in_one = [&animations](auto has) {
    return std::any_of(animations.begin(), animations.end(), has);
  };
  const auto any = [&in_one](auto has) {
    return in_one([&has](const Animation& animation) { return AnyPerson(animation, has); });
  };
  std::vector<std::string> whats;
  for (const Animation& animation : animations) {
    const std::vector<std::string> these = WhatsOf(animation);
    if (these.size() > whats.size()) whats = these;
  }
  std::string html;
  if (any(IsRecorded)) {
    html += Box("recorded", "recorded", "var(--recorded)");
    if (whats.size() == 1) html += Box("predicted", "predicted (in colour)");
  }
  for (size_t k = 0; whats.size() > 1 && k < whats.size(); ++k) {
    html += Box("what" + std::to_string(k), whats[k].empty() ? kAsFitted : whats[k],
                kAnimationColours[k % std::size(kAnimationColours)]);
  }
  if (any([](const AnimatedPerson& p) { return !p.tip.empty(); })) {
    html += Box("pendulums", "pendulums");
  }
  if (any(HasForce)) html += Box("forces", "net forces (1 m = 1000 N)", "#e0a100");
  if (any([](const AnimatedPerson& p) { return !p.footprints.empty(); })) {
    html += Box("footprints", "footprints");
  }
  html += Box("names", "names");
  if (in_one([](const Animation& a) { return NamesOf(a).size() > 1; })) {
    html += Box("above", "from above");
  }
  if (in_one([](const Animation& a) { return !a.pushes.empty(); })) {
    html += "<span>" + Chip("var(--push)") + " pushed, and the push</span>\n";
  }
  return html;
}

int Whole(double value) { return static_cast<int>(std::lround(value)); }

// Places of all points every so many frames, mm, each less that of the sample before: small
// numbers.
template <typename Points>
nlohmann::json Samples(const std::vector<Points>& frames, int every) {
  nlohmann::json json = nlohmann::json::array();
  std::vector<int> last;
  for (size_t t = 0; t < frames.size(); t += static_cast<size_t>(every)) {
    const Points& points = frames[t];
    last.resize(static_cast<size_t>(points.size()), 0);
    std::vector<int> sample(last.size());
    for (size_t i = 0; i < last.size(); ++i) {
      const int now = Whole(1000 * points.data()[i]);
      sample[i] = now - last[i];
      last[i] = now;
    }
    json.push_back(std::move(sample));
  }
  return json;
}

// Colours of people or what-ifs; where there are more people than colours, they come from a scale,
// so that neighbours look alike and no two are the same.
std::vector<std::string> ColoursOf(const Animation& animation,
                                   const std::vector<std::string>& whats) {
  const std::set<std::string> names = NamesOf(animation);
  std::vector<std::string> colours(std::begin(kAnimationColours), std::end(kAnimationColours));
  if (whats.size() > 1 || names.size() <= colours.size()) return colours;
  colours.clear();
  for (size_t n = 0; n < names.size(); ++n) {
    colours.push_back(
        ColourOf(kBrightest * static_cast<double>(n) / static_cast<double>(names.size() - 1)));
  }
  return colours;
}

nlohmann::json PersonJson(const AnimatedPerson& person, const std::vector<std::string>& whats,
                          int every) {
  nlohmann::json force = nlohmann::json::array();
  for (size_t t = 0; t < person.force.size(); t += static_cast<size_t>(every)) {
    force.push_back({Whole(person.force[t][0]), Whole(person.force[t][1])});
  }
  nlohmann::json prints = nlohmann::json::array();
  for (const Footprint& p : person.footprints) {
    prints.push_back({Whole(1000 * p.place[0]), Whole(1000 * p.place[1]), p.landing, p.lift_off});
  }
  return {{"name", person.name},
          {"recorded", person.recorded},
          {"what", std::find(whats.begin(), whats.end(), person.what) - whats.begin()},
          {"body", Samples(person.joints, every)},
          {"parents", person.parents},
          {"head", person.head},
          {"footprints", std::move(prints)},
          {"facing", person.facing},
          {"cart", Samples(person.cart, every)},
          {"tip", Samples(person.tip, every)},
          {"force", std::move(force)}};
}

nlohmann::json AnimationJson(const Animation& animation, double sample_seconds) {
  const std::vector<std::string> whats = WhatsOf(animation);
  const int every = std::max(1, Whole(sample_seconds / animation.dt));
  nlohmann::json data = {
      {"title", animation.title},
      {"dt", animation.dt},
      {"every", every},
      {"frames", (animation.num_frames() - 1) / every * every + 1},
      {"whats", whats},
      {"sole", {500 * (kSoleBefore - kSoleBehind), 500 * (kSoleBefore + kSoleBehind)}},
      {"colours", ColoursOf(animation, whats)},
      {"people", nlohmann::json::array()},
      {"pushes", nlohmann::json::array()}};
  for (const AnimatedPerson& person : animation.people) {
    data["people"].push_back(PersonJson(person, whats, every));
  }
  for (const AnimatedPush& push : animation.pushes) {
    nlohmann::json force = nlohmann::json::array();
    for (const auto& f : push.force) force.push_back({Whole(f[0]), Whole(f[1])});
    data["pushes"].push_back(
        {{"person", push.person}, {"start", push.start}, {"force", std::move(force)}});
  }
  return data;
}

}  // namespace

std::string AnimationHtml(const std::vector<Animation>& animations, double sample_seconds) {
  nlohmann::json data = nlohmann::json::array();
  for (const Animation& animation : animations) {
    data.push_back(AnimationJson(animation, sample_seconds));
  }
  const Animation& first = animations.front();
  return kHead + EscapeXml(first.title) + kStyle + Choices(animations) +
         (first.told.empty() ? ""
                             : "<p style=\"flex-basis:100%\">" + EscapeXml(first.told) + "</p>\n") +
         kCanvas + FiguresHtml(first.figures) + "<script>\nconst all=" +
         ForScript(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) + kScript;
}

void AnimatedPerson::SetBody(const BodyMotion& body) {
  if (body.empty()) return;
  joints.assign(body.begin(), body.end());
  parents.assign(kBodyParents.begin(), kBodyParents.end());
  head = kBodyHead;
}

int Animation::num_frames() const {
  size_t frames = 0;
  for (const AnimatedPerson& person : people) {
    frames = std::max(frames, person.tip.size());
    if (person.head >= 0 || person.tip.empty()) frames = std::max(frames, person.joints.size());
  }
  return static_cast<int>(frames);
}

std::vector<std::string> WhatsOf(const Animation& animation) {
  std::vector<std::string> whats;
  for (const AnimatedPerson& person : animation.people) {
    const bool known = std::find(whats.begin(), whats.end(), person.what) != whats.end();
    if (!person.recorded && !known) whats.push_back(person.what);
  }
  return whats;
}

void AddPrediction(const PendulumRecording& recording, const Prediction& prediction,
                   const std::vector<BodyMotion>& bodies, Animation* animation,
                   const std::string& what) {
  const FootprintsOfPeople prints = PredictedFootprints(recording, prediction);
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    AnimatedPerson person;
    person.name = recording.subject_ids[n];
    person.what = what;
    if (n < static_cast<int>(bodies.size())) person.SetBody(bodies[n]);
    person.tip = prediction.hip[n];
    if (n < static_cast<int>(prints.size())) person.footprints = prints[n];
    person.facing = recording.facing;
    for (int t = 0; t < prediction.path.num_frames(); ++t) {
      const Vector4<double>& q = prediction.path.At(t, n).q;
      person.cart.emplace_back(q[0], q[1], prediction.BodyAt(recording.scene, t, n).cart_height);
      person.force.push_back(prediction.forces.At(t, n).Total());
    }
    animation->people.push_back(std::move(person));
  }
}

void AddPushes(const PendulumRecording& recording, Animation* animation) {
  for (const ScenePush& push : recording.scene.pushes) {
    animation->pushes.push_back({recording.subject_ids[push.person], push.start_frame, push.force});
  }
}

void AddRecorded(const PendulumRecording& recording, const std::vector<BodyMotion>& bodies,
                 Animation* animation) {
  const FootprintsOfPeople prints = RecordedFootprints(recording);
  for (size_t n = 0; n < recording.subject_ids.size(); ++n) {
    AnimatedPerson person;
    person.name = recording.subject_ids[n];
    person.recorded = true;
    person.facing = recording.facing;
    if (n < bodies.size()) person.SetBody(bodies[n]);
    if (n < prints.size()) person.footprints = prints[n];
    const double cart_height = recording.scene.people[n].body.cart_height;
    for (const PendulumState<double>& state : recording.states[n]) {
      person.cart.emplace_back(state.q[0], state.q[1], cart_height);
    }
    person.tip = recording.hip[n];
    animation->people.push_back(std::move(person));
  }
}

void AddForecast(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation) {
  for (size_t n = 0; n < bodies.size(); ++n) {
    AnimatedPerson person;
    person.name = names[n];
    person.SetBody(bodies[n]);
    animation->people.push_back(std::move(person));
  }
}

}  // namespace pushid
