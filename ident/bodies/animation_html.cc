// ident: the page that shows an animation. Positions are whole millimetres, forces whole newtons.
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "ident/bodies/animation.h"
#include "ident/figures/moving_page.h"

namespace pushid {
namespace {

constexpr char kChoices[] =
    R"html(<label><input type="checkbox" id="recorded" checked> recorded (grey)</label>
<label><input type="checkbox" id="predicted" checked> predicted (colour)</label>
<label><input type="checkbox" id="pendulums" checked> pendulums</label>
<label><input type="checkbox" id="forces" checked> net forces (1 m = 1000 N)</label>)html";

constexpr char kScript[] =
    R"html(const parents=[-1,0,1,2,3,4,3,6,7,8,3,10,11,12,0,14,15,16,0,18,19,20];
const colours=['#2a78c8','#d1691f','#2f9e57','#9b59b6','#c0392b','#16a085','#b8860b','#6c5ce7'];
let frame=0,turn=-0.6,tilt=0.25,zoom=1,centre=[0,0,900],size=1500;
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

}  // namespace

std::string AnimationHtml(const Animation& animation) {
  nlohmann::json data = {{"title", animation.title},
                         {"dt", animation.dt},
                         {"frames", animation.num_frames()},
                         {"people", nlohmann::json::array()}};
  for (const AnimatedPerson& person : animation.people)
    data["people"].push_back(PersonJson(person));
  return ToHtml({"People in motion", "--grid:#ddd;--recorded:#8a8a8a",
                 "--grid:#3a3f46;--recorded:#a0a0a0", kChoices, std::move(data), kScript});
}

}  // namespace pushid
