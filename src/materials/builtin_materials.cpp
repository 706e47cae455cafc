#include "materials/builtin_materials.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "io/file.h"
#include "io/merl.h"
#include "materials/builtin_models.h"

namespace lightband {

namespace {

// Part of the names of cached tables. Raise it whenever a model, a constant or the cell layout changes.
constexpr int cache_version = 2;

std::filesystem::path cache_file(const std::string& name, const std::string& cache_path) {
    return std::filesystem::path(cache_path) / text(name, "-v", cache_version, ".binary");
}

// Whether a table read from a file is this model's: compares one cell in every thousand. A file keeps float values
// through a scaling in double precision; builds for other processors may round a model's last digits otherwise.
bool agrees(const BrdfTable& table, const ReflectanceModel& model) {
    constexpr size_t stride = 997;  // prime, so that all three angles vary
    constexpr float relative_tolerance = 1e-5f;
    for (size_t cell = 0; cell < BrdfTable::cell_count; cell += stride) {
        const Vec3 expected = cell_value(model, cell);
        for (int channel = 0; channel < 3; ++channel) {
            const float limit = relative_tolerance * std::fabs(float(expected[channel]));
            if (!(std::fabs(table.rgb[3 * cell + channel] - float(expected[channel])) <= limit)) return false;
        }
    }
    return true;
}

// Reads the table that an earlier call left. False when there is none, or when it is damaged or another model's.
bool read_cache(const std::filesystem::path& file, const ReflectanceModel& model, BrdfTable& table) {
    if (!io::exists(file.string())) return false;
    try {
        table = io::read_merl(file.string());
    } catch (const Error&) {
        return false;
    }
    return agrees(table, model);
}

// Leaves the table for later calls, where the folder lets itself be written.
void write_cache(const std::filesystem::path& file, const BrdfTable& table) {
    std::error_code no_folder;
    std::filesystem::create_directories(file.parent_path(), no_folder);
    if (no_folder) return;
    try {
        io::write_merl(file.string(), table);
    } catch (const Error&) {
        return;
    }
}

const BuiltinModel& find_model(const std::string& name) {
    std::string known;
    for (const BuiltinModel& candidate : builtin_models) {
        if (name == candidate.name) return candidate;
        known += (known.empty() ? "" : ", ") + std::string(candidate.name);
    }
    throw Error(LB_ERROR_INVALID_ARGUMENT, text("name: no built-in material \"", name, "\"; there are ", known));
}

}  // namespace

BrdfTable builtin_material(const std::string& name, const std::string& cache_path) {
    const std::unique_ptr<ReflectanceModel> model = find_model(name).make();
    if (cache_path.empty()) return tabulated(*model);

    const std::filesystem::path file = cache_file(name, cache_path);
    BrdfTable table;
    if (!read_cache(file, *model, table)) {
        table = tabulated(*model);
        write_cache(file, table);
    }
    return table;
}

}  // namespace lightband
