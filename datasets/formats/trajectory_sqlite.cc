// datasets: JuPedSim's SQLite files.
#include <sqlite3.h>

#include <memory>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/trajectories.h"
#include "datasets/formats/units.h"

namespace pushid {
namespace {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

struct EndStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, EndStatement>;

constexpr char kTables[] =
    "CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL, "
    "pos_x REAL NOT NULL, pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL);"
    "CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);"
    "CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);"
    "CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);"
    "CREATE INDEX frame_id_idx ON trajectory_data(frame, id);";
constexpr double kMargin = 1.0;        // m, of the walkable area
constexpr std::int64_t kGeometry = 1;  // the one there is

Error Failed(sqlite3* database, const std::string& path) {
  return Error{std::string("is not a SQLite file of JuPedSim: ") + sqlite3_errmsg(database), path};
}

Result<Statement> Prepare(sqlite3* database, const char* sql, const std::string& path) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database, sql, -1, &statement, nullptr) != SQLITE_OK) {
    return Failed(database, path);
  }
  return Statement(statement);
}

Result<double> ReadRate(sqlite3* database, const std::string& path) {
  Result<Statement> select =
      Prepare(database, "SELECT value FROM metadata WHERE key = 'fps'", path);
  if (!select.ok()) return select.error();
  const double rate = sqlite3_step(select.value().get()) == SQLITE_ROW
                          ? sqlite3_column_double(select.value().get(), 0)
                          : 0.0;
  const std::string problem = FrameRateProblem(rate);
  if (!problem.empty()) return Error{"fps in the table metadata " + problem, path};
  return rate;
}

MaybeError ReadRows(sqlite3* database, const std::string& path, TrajectoryRows* rows) {
  Result<Statement> select =
      Prepare(database, "SELECT id, frame, pos_x, pos_y FROM trajectory_data", path);
  if (!select.ok()) return select.error();
  sqlite3_stmt* row = select.value().get();
  int state = SQLITE_ROW;
  while ((state = sqlite3_step(row)) == SQLITE_ROW) {
    const std::int64_t id = sqlite3_column_int64(row, 0), frame = sqlite3_column_int64(row, 1);
    if (!rows->Add(id, frame,
                   {sqlite3_column_double(row, 2), sqlite3_column_double(row, 3), 0.0})) {
      return Error{"person " + std::to_string(id) + " is twice in frame " + std::to_string(frame),
                   path};
    }
  }
  if (state != SQLITE_DONE) return Failed(database, path);
  return std::nullopt;
}

// One INSERT for many rows.
MaybeError InsertAll(sqlite3* database, const std::string& path, const PointMotion& motion) {
  Result<Statement> insert =
      Prepare(database, "INSERT INTO trajectory_data VALUES (?, ?, ?, ?, 1, 0)", path);
  if (!insert.ok()) return insert.error();
  sqlite3_stmt* row = insert.value().get();
  const std::vector<std::int64_t> ids = TrajectoryIds(motion.names);
  for (int frame = 0; frame < motion.num_frames(); ++frame) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Eigen::Vector3d& position = motion.positions[i][frame];
      if (!position.allFinite()) continue;
      sqlite3_bind_int64(row, 1, frame);
      sqlite3_bind_int64(row, 2, ids[i]);
      sqlite3_bind_double(row, 3, position.x());
      sqlite3_bind_double(row, 4, position.y());
      if (sqlite3_step(row) != SQLITE_DONE) return Failed(database, path);
      sqlite3_reset(row);
    }
  }
  return std::nullopt;
}

// What else JuPedSim's readers ask for.
std::string AboutSql(const PointMotion& motion) {
  Eigen::Vector2d lowest = Eigen::Vector2d::Constant(1e300), highest = -lowest;
  for (const auto& track : motion.positions) {
    for (const Eigen::Vector3d& position : track) {
      if (!position.allFinite()) continue;
      lowest = lowest.cwiseMin(position.head<2>());
      highest = highest.cwiseMax(position.head<2>());
    }
  }
  const std::string x0 = DoubleText(lowest.x() - kMargin), y0 = DoubleText(lowest.y() - kMargin);
  const std::string x1 = DoubleText(highest.x() + kMargin), y1 = DoubleText(highest.y() + kMargin);
  const auto say = [](const char* key, const std::string& value) {
    return "INSERT INTO metadata VALUES ('" + std::string(key) + "', '" + value + "');";
  };
  const std::string geometry = std::to_string(kGeometry);
  return say("version", "2") + say("fps", DoubleText(motion.rate_hz)) + say("xmin", x0) +
         say("xmax", x1) + say("ymin", y0) + say("ymax", y1) + "INSERT INTO geometry VALUES (" +
         geometry + ", 'POLYGON ((" + x0 + " " + y0 + ", " + x1 + " " + y0 + ", " + x1 + " " + y1 +
         ", " + x0 + " " + y1 + ", " + x0 + " " + y0 + "))');" +
         "INSERT INTO frame_data SELECT DISTINCT frame, " + geometry +
         " FROM trajectory_data ORDER BY frame;";
}

}  // namespace

Result<PointMotion> ReadTrajectorySqlite(const std::string& path, const PointReadOptions& options) {
  InputFile exists;  // SQLite's message for a missing file does not say so
  if (MaybeError failed = exists.Open(path)) return *std::move(failed);
  sqlite3* opened = nullptr;
  const int state = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
  const Database database(opened);
  if (state != SQLITE_OK) return Failed(opened, path);
  PointMotion motion;
  motion.path = path;
  motion.unit = LengthUnit::kMetre;
  const Result<double> rate = ReadRate(opened, path);
  if (!rate.ok()) return rate.error();
  motion.rate_hz = rate.value();
  TrajectoryRows rows;
  if (MaybeError failed = ReadRows(opened, path, &rows)) return *std::move(failed);
  if (MaybeError failed = rows.Fill(options, &motion)) return *std::move(failed);
  const Result<std::string> hash = HashFile(path);
  if (!hash.ok()) return hash.error();
  motion.content_hash = hash.value();
  return motion;
}

MaybeError WriteTrajectorySqlite(const std::string& path, const PointMotion& motion) {
  sqlite3* opened = nullptr;
  const int state = sqlite3_open(":memory:", &opened);
  const Database database(opened);
  if (state != SQLITE_OK) return Failed(opened, path);
  const std::string begin = std::string(kTables) + "BEGIN;", end = AboutSql(motion) + "COMMIT;";
  if (sqlite3_exec(opened, begin.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    return Failed(opened, path);
  }
  if (MaybeError failed = InsertAll(opened, path, motion)) return failed;
  if (sqlite3_exec(opened, end.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    return Failed(opened, path);
  }
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, decltype(&sqlite3_free)> bytes(
      sqlite3_serialize(opened, "main", &size, 0), &sqlite3_free);
  if (bytes == nullptr) return Error{"there is not enough memory to write it", path};
  return WriteFileAtomically(
      path, {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)});
}

}  // namespace pushid
