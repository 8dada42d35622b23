#include <fmt/core.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "app/painter.h"
#include "app/progress.h"
#include "config/error.h"
#include "hal/image_io.h"
#include "lightfield/capture.h"
#include "render/leave_one_out.h"

namespace lumibox::app {
namespace {

nlohmann::json to_json(const render::Quality& quality) {
  return {{"psnr", quality.psnr},
          {"ssim", quality.ssim},
          {"psnr_subject", quality.psnr_subject},
          {"ssim_subject", quality.ssim_subject}};
}

nlohmann::json to_json(const std::vector<render::MethodQuality>& methods) {
  nlohmann::json rows = nlohmann::json::array();
  for (const render::MethodQuality& method : methods) {
    nlohmann::json row = to_json(method.mean);
    row["method"] = method.method;
    row["views"] = nlohmann::json::array();
    for (const render::ViewQuality& view : method.views) {
      nlohmann::json entry = to_json(view.quality);
      entry["perspective"] = view.perspective_id;
      entry["file"] = view.file;
      row["views"].push_back(entry);
    }
    rows.push_back(row);
  }
  return rows;
}

void print_table(const std::vector<render::MethodQuality>& methods) {
  std::printf("%-12s %8s %8s %14s %14s\n", "method", "psnr", "ssim", "psnr_subject",
              "ssim_subject");
  for (const render::MethodQuality& method : methods) {
    std::printf("%-12s %8.2f %8.3f %14.2f %14.3f\n", method.method.c_str(), method.mean.psnr,
                method.mean.ssim, method.mean.psnr_subject, method.mean.ssim_subject);
  }
}

}  // namespace

void evaluate(const EvaluateOptions& options) {
  const config::Config config = load_config(options.sources);
  for (const auto& result : {options.json, options.pictures}) {
    if (result) {
      refuse_recorded(*result, options.capture);
    }
  }
  if (options.json) {
    require_writable(*options.json);
  }
  const lightfield::Capture capture = lightfield::load_capture(options.capture);
  const auto& perspectives = capture.light_field.perspectives();
  if (perspectives.size() < 2) {
    throw config::InputError(options.capture, "holds fewer than the two perspectives needed");
  }
  if (options.pictures) {
    make_folder(*options.pictures);
  }
  Painter painter(options.reference ? Exactness::Exact : Exactness::Fast, config.render);
  render::ProxyGeometry proxy(capture.points, render::Estimating::AtOnce);
  std::size_t current = 0;
  const auto render_view = [&](const render::View& view,
                               const std::vector<lightfield::Perspective>& others,
                               const render::Method& method) {
    hal::Image picture =
        painter.paint(view, others, proxy.fit(method.settings, method.geometry, view, others));
    if (options.pictures) {
      const std::string name = fmt::format("{:06}-{}.png", perspectives[current].id, method.name);
      hal::write_png(*options.pictures / name, picture);
    }
    return picture;
  };
  std::vector<render::MethodQuality> methods;
  {
    Progress progress("evaluating", static_cast<std::int64_t>(perspectives.size()));
    methods = render::leave_one_out(perspectives, subject_of(capture), config.render, render_view,
                                    [&](std::size_t view) {
                                      current = view;
                                      progress.show(static_cast<std::int64_t>(view));
                                    });
  }
  require_all_pictures(capture);
  print_table(methods);
  if (options.json) {
    write_json(*options.json, to_json(methods));
  }
}

}  // namespace lumibox::app
