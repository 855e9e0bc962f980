#include "coupling/run_output.h"

#include "coupling/input_error.h"
#include "dd/common/units.h"

#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <unistd.h>

namespace ddfem::coupling
{
namespace
{
void write_array(std::ostream &out, const std::string &type, const std::string &name, const unsigned components,
                 const std::string &values)
{
  out << "<DataArray type=\"" << type << "\"";
  if (!name.empty())
    out << " Name=\"" << name << "\"";
  if (components > 1)
    out << " NumberOfComponents=\"" << components << "\"";
  out << " format=\"ascii\">\n" << values << "</DataArray>\n";
}

template <class Range, class F> std::string lines_of(const Range &range, F &&f)
{
  std::ostringstream out;
  out << std::setprecision(10);
  for (const auto i : range)
  {
    f(out, i);
    out << "\n";
  }
  return out.str();
}

std::string points_of_segments(const Network &network)
{
  // Two points per segment: in a periodic cell the end of a line may be another image of its node.
  return lines_of(network.segments(),
                  [&](std::ostream &o, const SegmentIndex s)
                  {
                    const Vec3 a = network.position(network.start(s)) / units::metre,
                               b = a + network.direction(s) / units::metre;
                    o << a.transpose() << "\n" << b.transpose();
                  });
}

void write_cells(std::ostream &out, const std::size_t n)
{
  std::ostringstream connectivity, offsets, types;
  for (std::size_t k = 0; k < n; ++k)
  {
    connectivity << 2 * k << " " << 2 * k + 1 << "\n";
    offsets << 2 * k + 2 << "\n";
    types << "3\n";
  }
  out << "<Cells>\n";
  write_array(out, "Int64", "connectivity", 1, connectivity.str());
  write_array(out, "Int64", "offsets", 1, offsets.str());
  write_array(out, "UInt8", "types", 1, types.str());
  out << "</Cells>\n";
}

constexpr const char *history_header =
    "step,time [s],dt [s],strain [-],stress [Pa],axial plastic strain [-],plastic strain xx [-],plastic strain yy [-],"
    "plastic strain zz [-],plastic strain xy [-],plastic strain xz [-],plastic strain yz [-],line length [m],"
    "dislocation density [1/m^2],segments,nodes,junction nodes,surface nodes,collisions,surface exits,"
    "reaction fixed face [N],reaction platen [N],FEM iterations,force imbalance [-],moment imbalance [-],"
    "integrator stages,max speed [m/s],wall time [s],stage,elastic strain [-],"
    "platen force x [N],platen force y [N],platen force z [N],"
    "platen moment x [N m],platen moment y [N m],platen moment z [N m],"
    "fixed face force x [N],fixed face force y [N],fixed face force z [N],"
    "fixed face moment x [N m],fixed face moment y [N m],fixed face moment z [N m],"
    "work [J],stored energy [J],dissipated energy [J],dissipated by topology [J],energy mismatch [-],cross-slips\n";
} // namespace

void write_file(const std::string &path, const std::string &content)
{
  const std::string temporary = path + ".part";
  {
    std::ofstream out(temporary);
    out << content;
    out.close();
    if (!out)
      throw FileAccessError(path + ": cannot be written");
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error)
    throw FileAccessError(path + ": cannot be written: " + error.message());
}

void write_network_vtu(const std::string &path, const Network &network)
{
  const auto segments = network.segments();
  const std::size_t n = segments.size();
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      << "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << 2 * n << "\" NumberOfCells=\"" << n << "\">\n<Points>\n";
  write_array(out, "Float64", "", 3, points_of_segments(network));
  out << "</Points>\n";
  write_cells(out, n);
  const auto both_ends = [&](auto &&value)
  {
    return lines_of(segments, [&](std::ostream &o, const SegmentIndex s)
                    { o << value(network.start(s)) << " " << value(network.end(s)); });
  };
  out << "<PointData>\n";
  write_array(out, "Int64", "node id", 1, both_ends([&](const NodeIndex i) { return network.id(i); }));
  write_array(out, "Int32", "constraint", 1,
              both_ends([&](const NodeIndex i) { return static_cast<int>(network.constraint(i)); }));
  out << "</PointData>\n<CellData>\n";
  write_array(out, "Float64", "Burgers vector [m]", 3,
              lines_of(segments, [&](std::ostream &o, const SegmentIndex s)
                       { o << (network.burgers(s) / units::metre).transpose(); }));
  write_array(out, "Float64", "plane normal", 3,
              lines_of(segments, [&](std::ostream &o, const SegmentIndex s) { o << network.normal(s).transpose(); }));
  write_array(out, "Float64", "screw fraction", 1,
              lines_of(segments, [&](std::ostream &o, const SegmentIndex s)
                       { o << std::abs(network.direction(s).normalized().dot(network.burgers(s).normalized())); }));
  write_array(out, "Int64", "segment id", 1,
              lines_of(segments, [&](std::ostream &o, const SegmentIndex s) { o << network.id(s); }));
  out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_file(path, out.str());
}

RunOutput::RunOutput(std::string directory, const bool write)
    : path(std::move(directory)), active(write)
      // mpirun gives its processes a terminal even when its own output goes to a file.
      ,
      terminal(write && isatty(STDOUT_FILENO) != 0 && std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr)
{
  if (!active)
    return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw FileAccessError(path + ": cannot be created: " + error.message());
  history.open(path + "/history.csv");
  log_file.open(path + "/log.txt");
  if (!history || !log_file)
    throw FileAccessError(path + ": cannot be written to");
  history << history_header << std::flush;
}

void RunOutput::add_history(const HistoryRow &r)
{
  if (!active)
    return;
  std::ostringstream o;
  o << std::setprecision(12);
  const auto put = [&](const auto &value) { o << value << ","; };
  put(r.step), put(r.time / units::second), put(r.dt / units::second), put(r.strain), put(r.stress / units::pascal),
      put(r.axial_plastic_strain);
  for (Eigen::Index c = 0; c < 6; ++c)
    put(r.plastic_strain[c]);
  put(r.line_length / units::metre), put(r.density / units::per_square_metre), put(r.segments), put(r.nodes),
      put(r.junctions), put(r.surface_nodes), put(r.collisions), put(r.surface_exits),
      put(r.fixed_reaction / units::newton), put(r.platen_reaction / units::newton), put(r.fem_iterations),
      put(r.force_imbalance), put(r.moment_imbalance), put(r.stages), put(r.max_speed / units::metre_per_second),
      put(r.wall_time), put(r.stage), put(r.elastic_strain);
  const auto put_vector = [&](const Vec3 &v, const double unit)
  {
    for (Eigen::Index c = 0; c < 3; ++c)
      put(v[c] / unit);
  };
  put_vector(r.platen_force, units::newton), put_vector(r.platen_moment, units::newton_metre);
  put_vector(r.fixed_force, units::newton), put_vector(r.fixed_moment, units::newton_metre);
  put(r.work / units::joule), put(r.stored_energy / units::joule), put(r.dissipated_energy / units::joule),
      put(r.dissipated_by_topology / units::joule);
  put(r.energy_mismatch);
  o << r.cross_slips << "\n";
  history << o.str() << std::flush;
  if (!history)
    throw FileAccessError(path + "/history.csv: cannot be written");
}

void RunOutput::log(const std::string &line)
{
  if (!active)
    return;
  log_file << line << "\n" << std::flush;
  if (status_shown)
    std::cout << "\n";
  status_shown = false;
  std::cout << line << std::endl;
}

void RunOutput::status(const std::string &line)
{
  if (!terminal)
    return;
  std::cout << "\r" << line << "\x1b[K" << std::flush;
  status_shown = true;
}

void RunOutput::add_network_frame(const unsigned step, const double time, const Network &network)
{
  if (!active)
    return;
  std::ostringstream name;
  name << "dislocations_" << std::setfill('0') << std::setw(7) << step << ".vtu";
  write_network_vtu(path + "/" + name.str(), network);
  network_frames.emplace_back(time, name.str());
  write_collection("dislocations.pvd", network_frames);
}

void RunOutput::add_grain_frame(const double time, const std::string &file)
{
  if (!active)
    return;
  grain_frames.emplace_back(time, std::filesystem::path(file).filename().string());
  write_collection("grain.pvd", grain_frames);
}

void RunOutput::write_collection(const std::string &name, const Frames &frames) const
{
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<Collection>\n"
      << std::setprecision(12);
  for (const auto &[time, file] : frames)
    out << "<DataSet timestep=\"" << time / units::second << "\" part=\"0\" file=\"" << file << "\"/>\n";
  out << "</Collection>\n</VTKFile>\n";
  write_file(path + "/" + name, out.str());
}
} // namespace ddfem::coupling
