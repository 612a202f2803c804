# Writes OUTPUT, a table of the names and texts of FOLDER/*.glsl.
file(GLOB shaders ${FOLDER}/*.glsl)
set(rows "")
foreach(shader ${shaders})
  file(READ ${shader} text)
  get_filename_component(name ${shader} NAME)
  string(APPEND rows "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(
  WRITE ${OUTPUT}
  "#include \"gpu/shader_source.h\"

namespace textonbench {

const std::map<std::string, std::string, std::less<>>& shader_files() {
  static const std::map<std::string, std::string, std::less<>> files{
${rows}  };
  return files;
}

}  // namespace textonbench
")
