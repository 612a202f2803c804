#include "paper_figures/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <regex>
#include <stdexcept>
#include <string_view>

namespace textonbench {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

void run_gnuplot(const std::filesystem::path& script) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, script.parent_path().c_str());
  std::string program = "gnuplot", no_settings = "-d", name = script.filename().string();
  std::array<char*, 4> arguments{program.data(), no_settings.data(), name.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) {
    throw std::runtime_error("charts need gnuplot, which is not installed: apt-get install gnuplot-nox");
  }
  if (error != 0) throw std::runtime_error(fmt::format("gnuplot cannot be started (error {})", error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error(fmt::format("gnuplot was lost (error {})", errno));
  }
  if (status != 0)
    throw std::runtime_error(fmt::format("gnuplot failed on {} (wait status {})", script.string(), status));
}

std::string annotated_svg(const std::string& svg, const std::vector<PointNote>& notes) {
  static const std::regex hypertext(
      R"re(<g onmousemove="gnuplot_svg\.showHypertext\(evt,'#(\d+)'\)" onmouseout="[^"]*"><title> </title>\s*(<use [^>]*/>)</g>)re");
  std::string result;
  std::size_t found = 0;
  auto rest = svg.cbegin();
  for (std::sregex_iterator match(svg.begin(), svg.end(), hypertext), end; match != end; ++match, ++found) {
    const PointNote& note = notes.at(std::stoul((*match)[1]));
    result.append(rest, (*match)[0].first);
    result += fmt::format(R"(<a class="point" data-record="{}"><title>{}</title>{}</a>)", xml_escaped(note.record),
                          xml_escaped(note.text), (*match)[2].str());
    rest = (*match)[0].second;
  }
  result.append(rest, svg.cend());
  if (found != notes.size()) {
    throw std::runtime_error(fmt::format("gnuplot drew {} of the {} points of a chart", found, notes.size()));
  }
  static const std::regex self_description(R"re(\n<title>[^<]*</title>\n<desc>[^<]*</desc>\n)re");
  static const std::regex layer_title(R"re(<g id="[^"]*_plot_(\d+)" ><title>[^<]*</title>)re");
  static const std::regex text_boxes(R"re(\s*<filter [\s\S]*?</filter>)re");
  result = std::regex_replace(result, self_description, "\n");
  result = std::regex_replace(result, layer_title, "<g>");
  return std::regex_replace(result, text_boxes, "");
}

std::string linked_svg(const std::string& svg, const std::string& prefix) {
  std::string result = svg.substr(svg.find("<svg"));
  replace_all(result, "id='", "id='" + prefix + "-");
  replace_all(result, "id=\"", "id=\"" + prefix + "-");
  replace_all(result, "href='#", "href='#" + prefix + "-");
  replace_all(result, "data-record=\"", "href=\"#r-");
  return result;
}

std::string undated_pdf(std::string pdf) {
  static constexpr std::string_view key = "/CreationDate (D:";
  const std::size_t at = pdf.find(key);
  if (at == std::string::npos) return pdf;
  // The length stays the same, so the file's table of offsets stays right.
  for (std::size_t i = at + key.size(); i < pdf.size() && pdf[i] >= '0' && pdf[i] <= '9'; ++i) pdf[i] = '0';
  pdf.replace(at + key.size(), 8, "20000101");
  return pdf;
}

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'')
      quoted += "''";
    else
      quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "'";
}

std::string xml_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

}  // namespace textonbench
