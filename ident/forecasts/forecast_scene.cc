// ident: a forecast as a page, a strip of poses, BVH and CSV. Positions in pages and BVH are
// millimetres.
#include "ident/forecasts/forecast_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "ident/figures/moving_page.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr char kChoices[] =
    R"html(<label><input type="checkbox" id="recorded" checked> recorded (grey)</label>
<label><input type="checkbox" id="forecast" checked> forecast (blue)</label>
<label><input type="checkbox" id="futures" checked> sampled futures (faint)</label>
<label><input type="checkbox" id="trails" checked> paths of hands and feet</label>)html";

constexpr char kScript[] = R"html(let frame,turn=0.7,tilt=0.15,zoom=1;
const lo=[1e9,1e9,1e9],hi=[-1e9,-1e9,-1e9];
for(const f of data.observed_motion.concat(data.forecast))for(let i=0;i<f.length;i++){lo[i%3]=Math.min(lo[i%3],f[i]);hi[i%3]=Math.max(hi[i%3],f[i]);}
const up=data.up,a=(up+1)%3,b=(up+2)%3,centre=lo.map((l,i)=>(l+hi[i])/2),size=Math.max(...hi.map((h,i)=>h-lo[i]))*1.25;
function open(){frame=data.observed-1;}
function project(p){const x=p[a]-centre[a],y=p[b]-centre[b],z=p[up]-centre[up],c=Math.cos(turn),s=Math.sin(turn);
 const k=zoom*Math.min(view.width,view.height)/size,d=s*x+c*y;
 return [view.width/2+k*(c*x-s*y),view.height/2-k*(Math.cos(tilt)*z+Math.sin(tilt)*d)];}
function line(p,q){const u=project(p),v=project(q);pen.beginPath();pen.moveTo(...u);pen.lineTo(...v);pen.stroke();}
const at=(f,j)=>f.slice(3*j,3*j+3);
function body(f,colour,width,alpha){if(!f)return;pen.strokeStyle=colour;pen.lineWidth=width;pen.globalAlpha=alpha;
 data.parents.forEach((p,j)=>{if(p===-2)return;line(p===-1?data.fixed[j]:at(f,p),at(f,j));if(p===-1)line([0,0,0],data.fixed[j]);});pen.globalAlpha=1;}
function trail(motion,until,colour,alpha){pen.strokeStyle=colour;pen.lineWidth=1.5;pen.globalAlpha=alpha;
 for(const j of data.ends){let before=at(data.observed_motion[data.observed-1],j);
  for(let t=0;t<=until&&t<motion.length;t++){const here=at(motion[t],j);line(before,here);before=here;}}pen.globalAlpha=1;}
function draw(){const d=devicePixelRatio||1;view.width=view.clientWidth*d;view.height=view.clientHeight*d;
 pen.lineCap='round';pen.clearRect(0,0,view.width,view.height);const t=frame-data.observed;
 if($('futures').checked)for(const f of data.futures){body(f[t],style('--future'),d,0.3);if($('trails').checked)trail(f,t,style('--future'),0.5);}
 if($('recorded').checked){body(t<0?data.observed_motion[frame]:data.recorded[t],style('--recorded'),4*d,0.8);if($('trails').checked)trail(data.recorded,t,style('--recorded'),1);}
 if($('forecast').checked){body(data.forecast[t],style('--forecast'),3*d,1);if($('trails').checked)trail(data.forecast,t,style('--forecast'),1);}
 $('clock').textContent=((t+1)*data.dt).toFixed(2)+' s, '+(t<0?'observed':'forecast');$('time').value=frame;}
)html";

nlohmann::json Frames(const Trajectories& motion) {
  nlohmann::json frames = nlohmann::json::array();
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    nlohmann::json numbers = nlohmann::json::array();
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
      numbers.push_back(std::lround(kMillimetres * motion(i, t)));
    }
    frames.push_back(std::move(numbers));
  }
  return frames;
}

// What ends a limb: nothing hangs on it.
std::vector<int> Ends(const ParticleLayout& layout) {
  std::vector<int> ends;
  for (int i = 0; i < layout.num_particles(); ++i) {
    if (std::count(layout.parents.begin(), layout.parents.end(), i) == 0) ends.push_back(i);
  }
  return ends;
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
    const Eigen::Vector3f place = kMillimetres * scene.layout.fixed.col(i);
    data["fixed"].push_back(
        {std::lround(place.x()), std::lround(place.y()), std::lround(place.z())});
  }
  for (const SampledFuture& future : scene.futures) {
    data["futures"].push_back(Frames(future.motion));
  }
  return ToHtml({"A forecast over the recorded motion",
                 "--recorded:#777;--forecast:#1f6fc0;--future:#5fa3e0",
                 "--recorded:#aaa;--forecast:#6db3ff;--future:#3f7fc0", kChoices,
                 nlohmann::json::array({std::move(data)}), kScript});
}

namespace {

constexpr double kStripHeight = 260, kTop = 40, kBottom = 26, kSide = 16;
constexpr size_t kMostFutures = 20;  // more of them hide one another

struct View {
  int across, up;  // axes of the picture
  double low_across, high_across, low_up, high_up;
};

View ViewOf(const ForecastScene& scene) {
  const ParticleLayout& layout = scene.layout;
  View view{3 - layout.up_axis - layout.mirrored_axis, layout.up_axis, 1e9, -1e9, 1e9, -1e9};
  const auto see = [&view](const Trajectories& motion) {
    for (Eigen::Index t = 0; t < motion.cols(); ++t) {
      for (Eigen::Index i = 0; i + 2 < motion.rows(); i += 3) {
        view.low_across = std::min<double>(view.low_across, motion(i + view.across, t));
        view.high_across = std::max<double>(view.high_across, motion(i + view.across, t));
        view.low_up = std::min<double>(view.low_up, motion(i + view.up, t));
        view.high_up = std::max<double>(view.high_up, motion(i + view.up, t));
      }
    }
  };
  for (const Trajectories* motion : {&scene.observed, &scene.recorded, &scene.forecast}) {
    see(*motion);
  }
  for (size_t i = 0; i < std::min(kMostFutures, scene.futures.size()); ++i) {
    see(scene.futures[i].motion);
  }
  return view;
}

}  // namespace

std::string ForecastStripSvg(const ForecastScene& scene, int poses) {
  const View view = ViewOf(scene);
  const double scale = (kStripHeight - kTop - kBottom) / std::max(0.1, view.high_up - view.low_up);
  const double panel = scale * (view.high_across - view.low_across) + kSide;
  const double width = std::max(520.0, poses * panel + kSide);
  SvgPicture svg(width, kStripHeight, scene.title);
  svg.Text(kSide, 18, scene.title, "ink bold");
  svg.Text(kSide, 32, "recorded grey, sampled futures faint, forecast blue", "faint small");
  const auto draw = [&](const Trajectories& motion, Eigen::Index t, double left,
                        const std::string& look) {
    if (t < 0 || t >= motion.cols()) return;
    const auto x = [&](const Eigen::Vector3f& p) {
      return left + scale * (p(view.across) - view.low_across);
    };
    const auto y = [&](const Eigen::Vector3f& p) {
      return kStripHeight - kBottom - scale * (p(view.up) - view.low_up);
    };
    for (int i = 0; i < scene.layout.num_particles(); ++i) {
      const int parent = scene.layout.parents[i];
      if (parent == kNoBone) continue;
      const Eigen::Vector3f end = motion.col(t).segment<3>(3 * i);
      const Eigen::Vector3f start = parent == kFixedPoint
                                        ? Eigen::Vector3f(scene.layout.fixed.col(i))
                                        : Eigen::Vector3f(motion.col(t).segment<3>(3 * parent));
      svg.Line(x(start), y(start), x(end), y(end), look);
      // All fixed points hang on the root, which is the origin.
      const Eigen::Vector3f root = Eigen::Vector3f::Zero();
      if (parent == kFixedPoint) svg.Line(x(root), y(root), x(start), y(start), look);
    }
  };
  const int observed = scene.num_observed(), last = scene.num_frames() - 1;
  for (int k = 0; k < poses; ++k) {
    const double share = poses > 1 ? static_cast<double>(k) / (poses - 1) : 1.0;
    const int frame = static_cast<int>(std::lround(observed - 1 + share * (last - (observed - 1))));
    const int t = frame - observed;
    const double left = kSide + k * panel;
    for (size_t i = 0; i < std::min(kMostFutures, scene.futures.size()); ++i) {
      draw(scene.futures[i].motion, t, left, "stroke:#7fb3e6;stroke-width:1;opacity:0.35");
    }
    draw(t < 0 ? scene.observed : scene.recorded, t < 0 ? frame : t, left,
         "stroke:#8a8a8a;stroke-width:3");
    draw(scene.forecast, t, left, "stroke:#2a78c8;stroke-width:2");
    svg.Text(left + 0.5 * (panel - kSide), kStripHeight - 8, Rounded((t + 1) * scene.dt, 3) + " s",
             "axis middle");
  }
  return svg.ToString();
}

namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;

// Particles in the order of a BVH file, every one followed by what hangs on it.
void AddBelow(const ParticleLayout& layout, int parent, std::vector<int>* order) {
  for (int i = 0; i < layout.num_particles(); ++i) {
    if (layout.parents[i] != parent) continue;
    order->push_back(i);
    AddBelow(layout, i, order);
  }
}

std::string WithoutEnding(const std::string& path) {
  const std::filesystem::path whole(path);
  return (whole.parent_path() / whole.stem()).string();
}

void AppendRows(const char* source, int future, const Trajectories& motion, int first_frame,
                const ForecastScene& scene, AtomicFile* file) {
  char row[256];
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    const int frame = first_frame + static_cast<int>(t);
    for (int i = 0; i < scene.layout.num_particles(); ++i) {
      const Eigen::Vector3f p = motion.col(t).segment<3>(3 * i);
      std::snprintf(row, sizeof row, "%d,%.9g,%s,%d,%s,%.6f,%.6f,%.6f\n", frame, frame * scene.dt,
                    source, future, scene.layout.names[i].c_str(), p.x(), p.y(), p.z());
      file->Append(row);
    }
  }
}

MaybeError WriteCsv(const std::string& path, const ForecastScene& scene) {
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append("frame,time_s,source,future,joint,x_m,y_m,z_m\n");
  const int next = scene.num_observed();
  AppendRows("observed", 0, scene.observed, 0, scene, &file);
  AppendRows("recorded", 0, scene.recorded, next, scene, &file);
  AppendRows("forecast", 0, scene.forecast, next, scene, &file);
  for (size_t i = 0; i < scene.futures.size(); ++i) {
    AppendRows("future", static_cast<int>(i) + 1, scene.futures[i].motion, next, scene, &file);
  }
  return file.Commit();
}

MaybeError WriteOneBvh(const std::string& path, const ForecastScene& scene,
                       const Trajectories& next) {
  Trajectories whole(scene.observed.rows(), scene.observed.cols() + next.cols());
  whole << scene.observed, next;
  return WriteBvh(path, ToBvh(whole, scene.layout, scene.dt), kUnit);
}

}  // namespace

BvhMotion ToBvh(const Trajectories& motion, const ParticleLayout& layout, double dt) {
  BvhMotion bvh;
  bvh.length_unit = kUnit;
  bvh.frame_time_s = dt;
  std::vector<int> order;
  AddBelow(layout, kNoBone, &order);
  const bool has_fixed = order.empty();
  if (has_fixed) {
    BvhJoint root;
    root.name = "root";
    root.channels = DefaultBvhChannels(true);
    bvh.skeleton.joints.push_back(root);
    AddBelow(layout, kFixedPoint, &order);
  }
  const int first = has_fixed ? 1 : 0;
  std::vector<int> joint_of(layout.num_particles());
  for (size_t k = 0; k < order.size(); ++k) joint_of[order[k]] = static_cast<int>(k) + first;
  const auto local = [&](Eigen::Index t, int particle) -> Eigen::Vector3f {
    const Eigen::Vector3f place = motion.col(t).segment<3>(3 * particle);
    const int parent = layout.parents[particle];
    if (parent < 0) return kMillimetres * place;
    return kMillimetres * (place - motion.col(t).segment<3>(3 * parent));
  };
  for (int particle : order) {
    BvhJoint joint;
    joint.name = layout.names[particle];
    const int parent = layout.parents[particle];
    joint.parent = parent >= 0 ? joint_of[parent] : has_fixed ? 0 : -1;
    joint.offset = local(0, particle).cast<double>();
    joint.channels = DefaultBvhChannels(true);
    const auto hanging = std::count(layout.parents.begin(), layout.parents.end(), particle);
    if (hanging == 0) joint.end_sites.push_back(Eigen::Vector3d::Zero());
    bvh.skeleton.joints.push_back(joint);
  }
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    if (has_fixed) bvh.values.insert(bvh.values.end(), 6, 0.0);
    for (int particle : order) {
      const Eigen::Vector3f place = local(t, particle);
      for (int k = 0; k < 3; ++k) bvh.values.push_back(place(k));
      bvh.values.insert(bvh.values.end(), 3, 0.0);
    }
  }
  return bvh;
}

MaybeError CheckPosesPath(const std::string& flag, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (path.empty() || IsBodyFile(path) || ending == ".csv") return std::nullopt;
  return Error{flag + " is '" + path + "'; it must end in .bvh or .csv"};
}

Result<std::vector<std::string>> WritePoses(const std::string& path, const ForecastScene& scene) {
  if (MaybeError error = CheckPosesPath("the file of poses", path)) return *error;
  if (std::filesystem::path(path).extension() == ".csv") {
    if (MaybeError error = WriteCsv(path, scene)) return *error;
    return std::vector<std::string>{path};
  }
  std::vector<std::string> files = {path};
  if (MaybeError error = WriteOneBvh(path, scene, scene.forecast)) return *error;
  for (size_t i = 0; i < scene.futures.size(); ++i) {
    files.push_back(WithoutEnding(path) + "_future_" + std::to_string(i + 1) + ".bvh");
    if (MaybeError error = WriteOneBvh(files.back(), scene, scene.futures[i].motion)) return *error;
  }
  return files;
}

}  // namespace pushid
