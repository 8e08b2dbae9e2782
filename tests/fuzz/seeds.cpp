// SPDX-License-Identifier: Apache-2.0
// Writes what the fuzzers begin with: seeds SOURCE FOLDER, a folder for each fuzzer, with files like those people have.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "hal/recording/reader.hpp"
#include "tests/files/import/write_matlab.hpp"
#include "tools/files/can/candump.hpp"
#include "tools/files/exchange/mdf4.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

Record small_record() {
  Record record{"seed", "seed", 0.0, 1e-3, 8, {}};
  for (const auto& [name, unit] : {std::pair{"current", "A"}, {"command", "rad"}, {"piston", "m"}}) {
    Channel channel{name, unit, {}};
    for (std::size_t row = 0; row < record.rows; ++row) {
      channel.values.push_back(1e-4 * static_cast<double>(row));
    }
    record.channels.push_back(channel);
  }
  return record;
}

std::string recording(const std::string& topology, const std::string& model, std::size_t channels) {
  hal::RecordingHeader header;
  header.version = "1";
  header.topology = topology;
  header.period_ns = 1'000'000;
  header.steps_per_cycle = 1;
  header.actuators = 1;
  header.input = {"command", "rad"};
  for (std::size_t i = 0; i < channels; ++i) {
    header.channels.push_back({i == 0 ? "piston" : "engine", "m"});
  }
  header.start.assign(channels, 0.0);
  header.model = model;
  std::string text = hal::header_text(header);
  for (std::uint64_t cycle = 0; cycle < 3; ++cycle) {
    hal::CycleHead head;
    head.cycle = cycle;
    std::string content(reinterpret_cast<const char*>(&head), sizeof head);
    content.append((1 + channels) * sizeof(double), '\0');
    hal::BlockHead block;
    block.cycles = 1;
    block.checksum = block.checksum_with(std::as_bytes(std::span(content)));
    text.append(reinterpret_cast<const char*>(&block), sizeof block).append(content);
  }
  hal::BlockHead end;
  end.kind = hal::BlockHead::kEnd;
  end.checksum = end.checksum_with({});
  return text.append(reinterpret_cast<const char*>(&end), sizeof end);
}

void write_all(const fs::path& source, const fs::path& folder) {
  write(folder / "dbc/own", content_of(source / "firmware/can/hotfire.dbc"));
  write(folder / "dbc/small",
        "BO_ 256 A: 8 X\n SG_ s m3 : 7|16@0- (0.5,-1) [0|10] \"mm\" Y\n SG_ w M : 16|8@1+ (1,0) [0|0] \"\" Y\n"
        "CM_ \"two\nlines\";\nBA_ \"GenMsgCycleTime\" BO_ 256 20;\nSIG_VALTYPE_ 256 s : 0;\nSG_MUL_VAL_ 256 s w 3-5;\n");
  const fs::path scratch = folder / "scratch";
  fs::create_directories(folder / "candump");
  write_candump(small_record(), folder / "candump/own.log", {1, 0.5});
  write(
      folder / "candump/foreign",
      "(1.000000) can0 100#E8030000\n(1.001000) can0 18FEF1FE#0001010000004000\n(1.002000) can0 18FEF1FE#0002010000004000\n"
      "(1.003000) can0 18FEF1FE#0003010000004000\n(1.0035) can0 123##112\n(1.0036) can0 123#R\n");
  write(folder / "toml/model", "0" + model_text(ModelFile{}));
  write(folder / "toml/vehicle", "1" + content_of(source / "docs/samples/taos.toml"));
  write(folder / "toml/profile", "2" + content_of(source / "docs/samples/lab_profile.toml"));
  write(folder / "toml/faults",
        "3schema = 1\n[[fault]]\nkind = \"leak\"\nactuator = 3\nfrom = 0.1\nto = 0.3\nvalue = 1e-9\n");
  write(folder / "toml/map",
        "4schema = 1\n[time]\ncolumn = \"t\"\nunit = \"ms\"\n[channels.command]\ncolumn = \"b:2\"\n"
        "unit = \"deg\"\nfactor = -1\n[csv]\ndelimiter = \";\"\nskip_lines = 1\n");
  write(folder / "toml/can_map", "5schema = 1\n[can]\nrows = \"F\"\n[channels.command]\ncolumn = \"F.s\"\n");
  write(folder / "csv/record", "# by hand\ntime[s],command[rad],piston[mm]\n0,0,0\n0.001,1e-3,0.5\n0.002,,\n0.003,2e-3,1\n");
  write(folder / "csv/lost_rows", "time[s],command[rad]\n0.003111111,1e-3\n0.002,,\n0.0031111,2e-3\n0.003111102,,\n");
  write(folder / "csv/vehicle", "time[ms],command.pitch1[deg],string1.engine1[m],vibration.yaw1[rad/s]\n0,1,2,3\n2,1,2,3\n");
  write(folder / "modes/small",
        "mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,gimbal.pitch1,gimbal.yaw1\n1,5,0.01,1e-3,0,1e-4,0\n"
        "residual.attach.pitch1,,,1e-9,0,0,0\nresidual.attach.yaw1,,,0,1e-9,0,0\nresidual.gimbal.pitch1,,,0,0,1e-9,0\n"
        "residual.gimbal.yaw1,,,0,0,0,1e-9\n");
  const std::string bench = "schema 1\ntopology direct\nmass.inertia 96\nmass.damping 200\nmass.stiffness 1e4\n";
  const std::string lab =
      "schema 1\ntopology lab\nactuators 1\npiston_per_command 0.5\nsegment.0.duration 0.1\nsegment.0.from 0\n";
  for (const char* sums : {"\x07", "\x03", "\x01"}) {
    write(folder / "recording" / ("plant" + std::to_string(sums[0])), sums + recording("direct", bench, 1));
    write(folder / "recording" / ("lab" + std::to_string(sums[0])), sums + recording("lab", lab, 5));
  }
  fs::create_directories(folder / "mdf4");
  write_mdf4(small_record(), folder / "mdf4/own");
  fs::create_directories(folder / "matlab");
  // Version 7.3 is HDF5, a library that its own project fuzzes (OSS-Fuzz).
  for (const auto& [kind, version] :
       {std::pair{"v4", test::MatlabVersion::v4}, {"v6", test::MatlabVersion::v6}, {"v7", test::MatlabVersion::v7}}) {
    const double values[] = {0.0, 1.0, 2.0};
    test::write_matlab_class(scratch, version, "X", "double", values, 3);
    write(folder / "matlab" / kind, std::string(1, '\0') + content_of(scratch));
  }
  test::write_matlab(scratch, {}, {"X", "beta", {1.0, 2.0, 3.0}});
  write(folder / "matlab/struct", "\x01" + content_of(scratch));
  test::write_matlab(scratch, {{"X", 2, 2, {1.0, 2.0, 3.0, 4.0}}}, {"Y", "beta", {1.0}});
  write(folder / "matlab/matrix", "\x02" + content_of(scratch));
  fs::remove(scratch);
}

}  // namespace
}  // namespace hotfire

int main(int count, char** values) {
  if (count != 3) {
    std::fputs("usage: seeds SOURCE FOLDER\n", stderr);
    return 2;
  }
  hotfire::write_all(values[1], values[2]);
}
