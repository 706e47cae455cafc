#include "sampling/light_tree.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace lightband {
namespace {

// Light is told apart down to blocks 0.7 degrees wide, each of which keeps its own centre.
constexpr uint32_t most_blocks_around = 512;

// Light of a block of texels: sums over it.
struct Block {
    Vec3 flux[Ceilings::count] = {};
    Vec3 moment{0};     // of directions, weighed by the mean of RGB flux above the first ceiling
    double weight = 0;  // that mean
    // From its middle to its edges, along a meridian and along a parallel.
    Vec3 down{0}, along{0};
    Vec3 direction() const { return moment / weight; }
};

struct Texel {
    double rgb[3], density;
};

Texel mix(const Texel& a, const Texel& b, double f) {
    Texel mixed;
    for (int c = 0; c < 3; ++c) mixed.rgb[c] = (1 - f) * a.rgb[c] + f * b.rgb[c];
    mixed.density = (1 - f) * a.density + f * b.density;
    return mixed;
}

// The two texels between whose middles a place along an axis lies, and how far it is from the first; with nearest lookup that which
// holds it.
struct Between {
    int64_t first, second;
    double part;
};
Between between(double place, Lookup lookup) {
    if (lookup == Lookup::nearest) return {int64_t(place), int64_t(place), 0};
    const double first = std::floor(place - 0.5);
    return {int64_t(first), int64_t(first) + 1, place - 0.5 - first};
}

// Lookups are made at the middles of cells, some to a texel: halves of texels integrate exactly what is linear between texels, and
// cells are never wider than blocks. A block is some cells wide and high.
struct Grid {
    uint32_t columns, rows, side;
    Grid(const RgbImage& map, Lookup lookup) {
        const uint32_t least = lookup == Lookup::linear ? 2 : 1;
        const uint32_t cells = std::max(least, least * ((most_blocks_around / least + map.width - 1) / map.width));
        columns = map.width * cells;
        rows = map.height * std::max(cells, least * ((most_blocks_around / least / 2 + map.height - 1) / map.height));
        side = (columns + most_blocks_around - 1) / most_blocks_around;
    }
    uint32_t around() const { return (columns + side - 1) / side; }
    uint32_t down() const { return (rows + side - 1) / side; }
};

// One row of the map, interpolated between texel rows where lookup is linear. y: in texels.
std::vector<Texel> row_at(const RgbImage& map, const MapSampler& sampler, Lookup lookup, double y) {
    const Between at = between(y, lookup);
    std::vector<Texel> row(map.width);
    for (uint32_t x = 0; x < map.width; ++x) {
        const auto texel = [&](int64_t r) {
            const uint32_t held = uint32_t(std::clamp<int64_t>(r, 0, map.height - 1));
            const float* rgb = map.texel(x, held);
            return Texel{{rgb[0], rgb[1], rgb[2]}, sampler.texel_pdf(x, held)};
        };
        row[x] = mix(texel(at.first), texel(at.second), at.part);
    }
    return row;
}

// Where a block lies, and from its middle to its edges.
Block empty_block(const Grid& grid, uint32_t column, uint32_t row) {
    const double height = double(grid.side) / grid.rows, width = double(grid.side) / grid.columns;
    const double polar = pi * (row + 0.5) * height, longitude = (0.5 - (column + 0.5) * width) * 2 * pi;
    Block block;
    block.down = pi * height / 2 * Vec3(std::cos(polar) * std::sin(longitude), -std::sin(polar), std::cos(polar) * std::cos(longitude));
    block.along = pi * width * std::sin(polar) * Vec3(std::cos(longitude), 0, -std::sin(longitude));
    return block;
}

std::vector<Block> blocks_of(const RgbImage& map, const MapSampler& sampler, Lookup lookup) {
    const Grid grid(map, lookup);
    const double unit = sampler.unit();
    std::vector<Block> blocks;
    for (uint32_t row = 0; row < grid.down(); ++row)
        for (uint32_t column = 0; column < grid.around(); ++column) blocks.push_back(empty_block(grid, column, row));
    std::vector<Vec2> longitudes(grid.columns);
    for (uint32_t i = 0; i < grid.columns; ++i) {
        const double longitude = (0.5 - (i + 0.5) / grid.columns) * 2 * pi;
        longitudes[i] = Vec2(std::sin(longitude), std::cos(longitude));
    }
    for (uint32_t j = 0; j < grid.rows; ++j) {
        const double polar = pi * (j + 0.5) / grid.rows;
        const double solid_angle = 2 * pi / grid.columns * (std::cos(pi * j / grid.rows) - std::cos(pi * (j + 1.0) / grid.rows));
        const std::vector<Texel> row = row_at(map, sampler, lookup, (j + 0.5) / grid.rows * map.height);
        for (uint32_t i = 0; i < grid.columns; ++i) {
            const Between at = between((i + 0.5) / grid.columns * map.width, lookup);
            const auto texel = [&](int64_t x) -> const Texel& { return row[size_t((x + map.width) % map.width)]; };
            const Texel light = mix(texel(at.first), texel(at.second), at.part);
            const Vec3 whole = solid_angle / unit * Vec3(light.rgb[0], light.rgb[1], light.rgb[2]);
            const double weight = Ceilings::part_above(0, light.density) * (whole.x + whole.y + whole.z) / 3;
            Block& block = blocks[size_t(j / grid.side) * grid.around() + i / grid.side];
            for (uint32_t layer = 0; layer < Ceilings::count; ++layer) block.flux[layer] += Ceilings::part_above(layer, light.density) * whole;
            block.weight += weight;
            block.moment += weight * Vec3(std::sin(polar) * longitudes[i].x, std::cos(polar), std::sin(polar) * longitudes[i].y);
        }
    }
    blocks.erase(std::remove_if(blocks.begin(), blocks.end(), [](const Block& block) { return !(block.weight > 0); }), blocks.end());
    return blocks;
}

// A run of blocks, and what their directions have in common.
struct Run {
    Block *first = nullptr, *last = nullptr;
    Vec3 mean{0};
    double weight = 0;
    Vec3 variance{0};  // of directions, along each axis
    double total_variance() const { return variance.x + variance.y + variance.z; }
};

Run run_of(Block* first, Block* last) {
    Run run{first, last};
    for (const Block* block = first; block != last; ++block) {
        run.mean += block->moment;
        run.weight += block->weight;
    }
    if (!(run.weight > 0)) return run;
    run.mean /= run.weight;
    for (const Block* block = first; block != last; ++block) {
        const Vec3 off = block->direction() - run.mean;
        // Light is even over a block: from -1 to 1, a third.
        run.variance += block->weight / run.weight * (off * off + (block->down * block->down + block->along * block->along) / 3.0);
    }
    return run;
}

// Two runs on either side of the mean along the axis on which the light spreads most; false where it has one place only.
bool halve(const Run& whole, Run* low, Run* high) {
    if (whole.last - whole.first < 2) return false;
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (whole.variance[i] > whole.variance[axis]) axis = i;
    const double mean = whole.mean[axis];
    Block* middle = std::partition(whole.first, whole.last, [=](const Block& block) { return block.direction()[axis] < mean; });
    if (middle == whole.first || middle == whole.last) return false;
    *low = run_of(whole.first, middle);
    *high = run_of(middle, whole.last);
    return true;
}

LightPart part_of(const Run& run) {
    LightPart part{{0, 1, 0}, 1, {}};
    if (!(run.weight > 0)) return part;
    const double length = glm::length(run.mean);
    const Vec3 middle = length > 0 ? run.mean / length : Vec3(0, 1, 0);
    double cosine = 1;
    Vec3 flux[Ceilings::count] = {};
    for (const Block* block = run.first; block != run.last; ++block) {
        for (const double side : {-1.0, 1.0})
            for (const Vec3& edge : {block->down + block->along, block->down - block->along})
                cosine = std::min(cosine, glm::dot(middle, glm::normalize(block->direction() + side * edge)));
        for (uint32_t layer = 0; layer < Ceilings::count; ++layer) flux[layer] += block->flux[layer];
    }
    for (int c = 0; c < 3; ++c) part.direction[c] = float(middle[c]);
    part.sine = float(cosine > 0 ? std::sqrt(std::max(0.0, 1 - cosine * cosine)) : 1);
    for (uint32_t layer = 0; layer < Ceilings::count; ++layer) {
        const Vec3& own = flux[layer];
        part.flux[layer] = {{float(own.x), float(own.y), float(own.z)}, float((own.x + own.y + own.z) / 3 * run.total_variance())};
    }
    return part;
}

// Half a block, across its longer side. The whole's light is even over it.
Block half_of(const Block& block, double side) {
    Block half = block;
    Vec3& cut = glm::length(block.down) > glm::length(block.along) ? half.down : half.along;
    cut *= 0.5;
    half.moment += side * block.weight * cut;
    half.moment *= 0.5;
    half.weight *= 0.5;
    for (Vec3& flux : half.flux) flux *= 0.5;
    return half;
}

// As many runs, or fewer where the light has fewer places, which the blocks are put into the order of.
std::vector<Run> trunk_of(std::vector<Block>* blocks, uint32_t count) {
    // The run that spreads most is halved first; the root keeps dim but wide parts from being left for last.
    const auto urgency = [](const Run& run) { return std::sqrt(run.weight) * run.total_variance(); };
    const auto less_urgent = [&](const Run& a, const Run& b) { return urgency(a) < urgency(b); };
    std::priority_queue<Run, std::vector<Run>, decltype(less_urgent)> queue(less_urgent);
    queue.push(run_of(blocks->data(), blocks->data() + blocks->size()));
    std::vector<Run> trunk;
    while (!queue.empty() && queue.size() + trunk.size() < count) {
        const Run run = queue.top();
        queue.pop();
        Run low, high;
        if (halve(run, &low, &high)) {
            queue.push(low);
            queue.push(high);
        } else {
            trunk.push_back(run);
        }
    }
    for (; !queue.empty(); queue.pop()) trunk.push_back(queue.top());
    return trunk;
}

void fill_heap(const Run& run, uint32_t place, size_t trunk_part, LightTree* tree) {
    tree->parts[LightTree::index(trunk_part, place)] = part_of(run);
    if (2 * place >= LightTree::heap) return;
    Run low, high;
    if (halve(run, &low, &high)) {
        fill_heap(low, 2 * place, trunk_part, tree);
        fill_heap(high, 2 * place + 1, trunk_part, tree);
        return;
    }
    for (uint32_t half = 0; half < 2; ++half) {
        std::vector<Block> blocks(run.first, run.last);
        for (Block& block : blocks) block = half_of(block, half == 0 ? -1 : 1);
        fill_heap(run_of(blocks.data(), blocks.data() + blocks.size()), 2 * place + half, trunk_part, tree);
    }
}

}  // namespace

LightTree light_tree(const RgbImage& map, const MapSampler& sampler, Lookup lookup) {
    std::vector<Block> blocks = blocks_of(map, sampler, lookup);
    LightTree tree;
    tree.parts.resize(size_t(LightTree::trunk_parts) * LightTree::heap);
    for (const LightTree::Trunk& own : LightTree::trunks) {
        const std::vector<Run> trunk = trunk_of(&blocks, own.count);
        for (size_t i = 0; i < trunk.size(); ++i) fill_heap(trunk[i], 1, own.first + i, &tree);
    }
    return tree;
}

}  // namespace lightband
