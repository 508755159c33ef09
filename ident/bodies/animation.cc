// ident: moving people as a page and as a strip of poses.
#include "ident/bodies/animation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/moving_page.h"

namespace pushid {
namespace {

constexpr double kBrightest = 0.85;  // of the scale of colours, that is seen on paper

constexpr char kScript[] =
    R"html(let frame=0,turn=-0.6,tilt=0.25,zoom=1,names,pushed,bodies,centre,size,origin,span;
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
// The forces on one person along the push, and where in its story we are.
const looks=['#d55e00','#9333ea','#009e73'];
function storyPanel(){if(!data.story)return;const d=devicePixelRatio||1,w=Math.min(330*d,view.width*0.5),h=120*d,x0=8*d,y0=view.height-h-8*d,F=data.story.forces;
 pen.globalAlpha=0.85;pen.fillStyle=style('--paper');pen.fillRect(x0,y0,w,h);pen.globalAlpha=1;pen.setLineDash([]);pen.lineWidth=d;pen.strokeStyle=style('--grid');pen.strokeRect(x0,y0,w,h);
 const most=Math.max(20,...F.flat().map(Math.abs)),X=t=>x0+w*t/Math.max(1,F.length-1),Y=f=>y0+h/2-f/most*(h/2-20*d);
 pen.beginPath();pen.moveTo(x0,Y(0));pen.lineTo(x0+w,Y(0));pen.stroke();
 for(let k=3;k>=0;k--){pen.strokeStyle=k===3?style('--ink'):looks[k];pen.lineWidth=(k===3?3:1.6)*d;pen.beginPath();F.forEach((f,t)=>t?pen.lineTo(X(t),Y(f[k])):pen.moveTo(X(t),Y(f[k])));pen.stroke();}
 const t=Math.min(frame,F.length-1);pen.strokeStyle=style('--push');pen.lineWidth=d;pen.beginPath();pen.moveTo(X(t),y0);pen.lineTo(X(t),y0+h);pen.stroke();
 pen.font=12*d+'px system-ui,sans-serif';pen.textAlign='left';pen.fillStyle=style('--ink');pen.fillText(Math.round(most)+' N along the push, '+data.story.person,x0+6*d,y0+14*d);
 ['net (thick)','push','others','own response'].forEach((text,k)=>{pen.fillStyle=k?looks[k-1]:style('--ink');pen.fillText(text,x0+(6+80*k)*d,y0+h-6*d);});
 data.story.moments.forEach((m,i)=>{const b=$('moment'+i);b.setAttribute('aria-current',frame>=m[0]&&frame<m[1]?'true':'false');});}
if(data.story)data.story.moments.forEach((m,i)=>{$('moment'+i).onclick=()=>{play(false);frame=m[0];draw();};});
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
 inset();storyPanel();
 $('clock').textContent=(frame*data.dt).toFixed(2)+' s, frame '+frame;$('time').value=frame;}
)html";

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
    html += "<span>" + Chip(kAnimatedPushColour) + " pushed, and the push</span>\n";
  }
  return html;
}

std::string StoryHtml(const Animation& animation) {
  if (!animation.story) return "";
  const ForceStory& story = animation.story->story;
  std::string html = "<div style=\"flex-basis:100%\">" + EscapeXml(animation.story->person) + ": ";
  for (size_t i = 0; i < story.moments.size(); ++i) {
    html += "<button class=\"moment\" id=\"moment" + std::to_string(i) + "\">" +
            Rounded(story.moments[i].from * animation.dt, 3) + " s " +
            EscapeXml(story.moments[i].text) + "</button>\n";
  }
  return html + "</div>\n";
}

// True where a strip of poses draws a person's joints: a body's, or those of people without a
// pendulum.
bool ShowsJoints(const AnimatedPerson& person, int t) {
  return t < static_cast<int>(person.joints.size()) && (person.head >= 0 || person.tip.empty());
}

int Whole(double value) { return static_cast<int>(std::lround(value)); }

// Every so many frames the places of all points, mm, each less that of the sample before: small
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
  if (animation.story) {
    const ForceStory& story = animation.story->story;
    nlohmann::json moments = nlohmann::json::array(), forces = nlohmann::json::array();
    for (const StoryMoment& moment : story.moments) moments.push_back({moment.from, moment.to});
    for (const std::array<double, 4>& f : story.forces) {
      forces.push_back({Whole(f[0]), Whole(f[1]), Whole(f[2]), Whole(f[3])});
    }
    data["story"] = {{"person", animation.story->person},
                     {"moments", std::move(moments)},
                     {"forces", std::move(forces)}};
  }
  return data;
}

constexpr double kStripHeight = 226, kTop = 56, kBottom = 34, kSide = 16;
constexpr double kHighest = 2.05;          // m, of a panel
constexpr double kNewtonsPerMetre = 1000;  // length of force arrows
constexpr double kLeastForce = 5.0;        // N, that is drawn

constexpr char kRecordedLook[] = "stroke:#9a9a9a;stroke-width:2;opacity:0.8";
constexpr char kPendulumLook[] = "stroke:#d1495b;stroke-width:1.5;stroke-dasharray:4 3";
constexpr char kForceLook[] = "stroke:#e0a100;stroke-width:3";

std::string PushLook() {
  return std::string("fill:none;stroke-width:2.5;stroke:") + kAnimatedPushColour;
}

// Right limbs darker than left ones, so that a pose reads from the side.
bool OnRight(int joint) { return (joint >= 6 && joint < 10) || (joint >= 14 && joint < 18); }

std::string ColourOfWhat(int what) {
  return kAnimationColours[static_cast<size_t>(what) % std::size(kAnimationColours)];
}

std::string BoneLook(const AnimatedPerson& person, int what, bool paler) {
  if (person.recorded) return kRecordedLook;
  return "stroke:" + ColourOfWhat(what) + ";stroke-width:2.2" + (paler ? ";opacity:0.6" : "");
}

// One moment: offset puts x = 0 m at a pixel.
class Panel {
 public:
  Panel(double pixels_per_metre, double x_pixel, double floor_pixel, SvgPicture* svg)
      : scale_(pixels_per_metre), x_(x_pixel), floor_(floor_pixel), svg_(svg) {}

  // `what`: which of the what-ifs; several are told apart by their pendulums too.
  void Draw(const AnimatedPerson& person, int what, bool several, int t) {
    if (ShowsJoints(person, t)) {
      const Eigen::Matrix3Xd& joints = person.joints[t];
      for (size_t j = 0; j < person.parents.size(); ++j) {
        if (person.parents[j] < 0) continue;
        const bool paler = person.head < 0 || !OnRight(static_cast<int>(j));
        Bone(joints.col(person.parents[j]), joints.col(static_cast<int>(j)),
             BoneLook(person, what, paler));
      }
      if (person.head >= 0) {
        const Eigen::Vector3d head = joints.col(person.head);
        svg_->Circle(X(head), Y(head), 0.085 * scale_,
                     person.recorded ? "fill:#9a9a9a;opacity:0.6" : "fill:" + ColourOfWhat(what));
      }
    }
    const bool hidden = person.recorded && person.head >= 0;  // the body says it all
    if (t < static_cast<int>(person.cart.size()) && !hidden) {
      const std::string colour = several ? ColourOfWhat(what) : "#d1495b";
      Bone(person.cart[t], person.tip[t],
           person.recorded ? kRecordedLook
           : several       ? "stroke:" + colour + ";stroke-width:1.5"
                           : kPendulumLook);
      svg_->Circle(X(person.tip[t]), Y(person.tip[t]), 3,
                   "fill:" + (person.recorded ? "#9a9a9a" : colour));
    }
    if (t >= static_cast<int>(person.force.size())) return;
    const Eigen::Vector3d force(person.force[t][0], person.force[t][1], 0.0);
    if (force.norm() < kLeastForce) return;
    Bone(person.tip[t], person.tip[t] + force / kNewtonsPerMetre, kForceLook);
  }

  // The feet that stand, the left one paler; recorded ones under predicted ones.
  void DrawFeet(const AnimatedPerson& person, int what, int t) {
    for (const Footprint& print : person.footprints) {
      if (t < print.landing || t >= print.lift_off) continue;
      const double ahead = std::cos(person.facing), x = x_ + scale_ * print.place.x();
      const double y = floor_ + (person.recorded ? 6.5 : 2.5);
      const char* const paler = print.foot == Foot::kLeft ? ";opacity:0.5" : "";
      svg_->Line(x - scale_ * kSoleBehind * ahead, y, x + scale_ * kSoleBefore * ahead, y,
                 "stroke-width:3;stroke:" +
                     (person.recorded ? std::string("#9a9a9a") : ColourOfWhat(what)) + paler);
    }
  }

  // A ring round the hip of who is pushed; while it acts the push, which ends there, and its size.
  void Mark(const Eigen::Vector3d& hip, const AnimatedPush& push, int t) {
    svg_->Circle(X(hip), Y(hip), 7, PushLook());
    if (t < push.start || t >= push.start + static_cast<int>(push.force.size())) return;
    const Vector4<double>& force = push.force[t - push.start];
    const double size = force.head<2>().norm();
    if (size < kLeastForce) return;
    Bone(hip - Eigen::Vector3d(force[0], force[1], 0.0) / kNewtonsPerMetre, hip, PushLook());
    const double back = force[0] < 0.0 ? 6.0 : -6.0;
    for (const double side : {-4.0, 4.0}) {
      svg_->Line(X(hip), Y(hip), X(hip) + back, Y(hip) + side, PushLook());
    }
    svg_->Text(X(hip), kTop + 4, SvgNumber(std::round(size)) + " N", "ink small middle");
  }

 private:
  double X(const Eigen::Vector3d& p) const { return x_ + scale_ * p.x(); }
  double Y(const Eigen::Vector3d& p) const { return floor_ - scale_ * p.z(); }
  void Bone(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const std::string& look) {
    svg_->Line(X(a), Y(a), X(b), Y(b), look);
  }

  const double scale_, x_, floor_;
  SvgPicture* svg_;
};

// A person's hip; none beyond the last frame.
std::optional<Eigen::Vector3d> HipAt(const AnimatedPerson& person, int t) {
  if (t < static_cast<int>(person.tip.size())) return person.tip[t];
  if (person.head >= 0 && ShowsJoints(person, t)) return person.joints[t].col(0);
  return std::nullopt;
}

// The way of everybody's joints, or hips, from one frame to the next: the sum over people.
double MotionTo(const Animation& animation, int t) {
  double sum = 0.0;
  for (const AnimatedPerson& person : animation.people) {
    if (ShowsJoints(person, t)) {
      sum += (person.joints[t] - person.joints[t - 1]).colwise().norm().mean();
    } else if (t < static_cast<int>(person.tip.size())) {
      sum += (person.tip[t] - person.tip[t - 1]).norm();
    }
  }
  return sum;
}

// Frames that part the motion into equal stretches, first and last among them; in time where
// nothing moves. Even frames would show a fall in one pose and waiting in six.
std::vector<int> FramesByMotion(const Animation& animation, int poses) {
  const int last = animation.num_frames() - 1;
  std::vector<double> way = {0.0};
  for (int t = 1; t <= last; ++t) way.push_back(way.back() + MotionTo(animation, t));
  std::vector<int> frames;
  for (int i = 0; i < poses; ++i) {
    const double share = poses > 1 ? static_cast<double>(i) / (poses - 1) : 0.0;
    const auto there = std::lower_bound(way.begin(), way.end(), share * way.back());
    const int by_motion = static_cast<int>(std::min<std::ptrdiff_t>(last, there - way.begin()));
    const int by_time = static_cast<int>(std::lround(share * last));
    frames.push_back(way.back() > 0.0 ? (i == poses - 1 ? last : by_motion) : by_time);
  }
  return frames;
}

// The frame of the hardest push takes the place of the nearest one: a short push would fall between
// two.
std::vector<int> FramesWithPush(const Animation& animation, int poses) {
  std::vector<int> frames = FramesByMotion(animation, poses);
  int hardest = -1;
  double most = kLeastForce;
  for (const AnimatedPush& push : animation.pushes) {
    for (size_t i = 0; i < push.force.size(); ++i) {
      const double size = push.force[i].head<2>().norm();
      if (size > most) most = size, hardest = push.start + static_cast<int>(i);
    }
  }
  if (hardest < 0 || hardest >= animation.num_frames() || poses < 3) return frames;
  const auto nearest = std::min_element(
      frames.begin() + 1, frames.end() - 1,
      [hardest](int a, int b) { return std::abs(a - hardest) < std::abs(b - hardest); });
  if (std::find(frames.begin(), frames.end(), hardest) == frames.end()) *nearest = hardest;
  std::sort(frames.begin(), frames.end());
  return frames;
}

// The legend of what the strip draws.
std::vector<LegendEntry> LegendOf(const Animation& animation) {
  std::vector<LegendEntry> legend;
  if (AnyPerson(animation, IsRecorded)) legend.push_back({"recorded", kRecordedLook});
  const std::vector<std::string> whats = WhatsOf(animation);
  const bool bodies =
      AnyPerson(animation, [](const AnimatedPerson& p) { return !p.recorded && p.head >= 0; });
  for (size_t k = 0; k < whats.size(); ++k) {
    const bool alone = whats.size() == 1 && whats[0].empty();
    if (alone && !bodies) continue;  // pendulums have an entry of their own
    legend.push_back({alone              ? "predicted, left limbs paler"
                      : whats[k].empty() ? kAsFitted
                                         : whats[k],
                      "stroke-width:2.5;stroke:" + ColourOfWhat(static_cast<int>(k))});
  }
  if (whats.size() == 1 &&
      AnyPerson(animation, [](const AnimatedPerson& p) { return !p.recorded && !p.tip.empty(); })) {
    legend.push_back({"pendulum", kPendulumLook});
  }
  if (AnyPerson(animation, HasForce)) legend.push_back({"net force, 1 m = 1000 N", kForceLook});
  if (!animation.pushes.empty()) legend.push_back({"pushed person and push", PushLook()});
  return legend;
}

// Smallest and largest x of everything that is shown.
std::pair<double, double> ExtentX(const Animation& animation) {
  double low = 1e9, high = -1e9;
  const auto see = [&](double x) { low = std::min(low, x), high = std::max(high, x); };
  for (const AnimatedPerson& person : animation.people) {
    for (const auto& tip : person.tip) see(tip.x());
    if (!ShowsJoints(person, 0)) continue;
    for (const auto& p : person.joints) see(p.row(0).minCoeff()), see(p.row(0).maxCoeff());
  }
  return low > high ? std::make_pair(-1.0, 1.0) : std::make_pair(low - 0.1, high + 0.1);
}

}  // namespace

std::string AnimationHtml(const std::vector<Animation>& animations, double sample_seconds) {
  nlohmann::json data = nlohmann::json::array();
  for (const Animation& animation : animations) {
    data.push_back(AnimationJson(animation, sample_seconds));
  }
  const Animation& first = animations.front();
  const std::string push = std::string("--push:") + kAnimatedPushColour + ";";
  return ToHtml({"People in motion", push + "--grid:#ddd;--recorded:#8a8a8a",
                 push + "--grid:#3a3f46;--recorded:#a0a0a0", Choices(animations) + StoryHtml(first),
                 std::move(data), kScript, first.figures});
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
    if (ShowsJoints(person, 0)) frames = std::max(frames, person.joints.size());
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

SvgPicture PoseStrip(const Animation& animation, int poses) {
  const auto [low, high] = ExtentX(animation);
  const double scale = (kStripHeight - kTop - kBottom) / kHighest;
  const double panel = scale * (high - low) + kSide;
  const double floor = kStripHeight - kBottom;
  const std::vector<LegendEntry> legend = LegendOf(animation);
  const double width = std::max({480.0, panel * poses + kSide, 2.0 * kSide + LegendWidth(legend)});
  SvgPicture svg(width, kStripHeight, animation.title);
  svg.Text(kSide, 18, animation.title, "ink bold");
  DrawLegend(legend, kSide, 38, &svg);
  svg.Line(0, floor, panel * poses + kSide, floor, "axis");
  const std::vector<std::string> whats = WhatsOf(animation);
  const std::vector<int> frames = FramesWithPush(animation, poses);
  for (int i = 0; i < poses; ++i) {
    const int t = frames[i];
    const double left = kSide + panel * i;
    Panel drawn(scale, left - scale * low, floor, &svg);
    for (const bool recorded : {true, false}) {
      for (const AnimatedPerson& person : animation.people) {
        if (person.recorded != recorded) continue;
        const auto what = std::find(whats.begin(), whats.end(), person.what) - whats.begin();
        drawn.Draw(person, static_cast<int>(what), whats.size() > 1, t);
        drawn.DrawFeet(person, static_cast<int>(what), t);
      }
    }
    for (const AnimatedPush& push : animation.pushes) {
      // The last of the name: predicted before recorded.
      for (auto p = animation.people.rbegin(); p != animation.people.rend(); ++p) {
        const auto hip = HipAt(*p, t);
        if (p->name != push.person || !hip) continue;
        drawn.Mark(*hip, push, t);
        break;
      }
    }
    svg.Text(left + 0.5 * (panel - kSide), floor + 22, Rounded(t * animation.dt, 3) + " s",
             "axis middle");
  }
  return svg;
}

}  // namespace pushid
