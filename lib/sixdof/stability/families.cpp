#include <sixdof/stability/families.h>

#include <array>
#include <random>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/stability/makers.h>

namespace sixdof::stability {
namespace {

template <class... Lists>
std::vector<Case> joined(Lists... lists) {
  std::vector<Case> all;
  (all.insert(all.end(), lists.begin(), lists.end()), ...);
  return all;
}

const std::array k_families{
    Family{1, "scale", "Both bodies scaled alike give the same answer in the new unit.", "factor 1e-6 .. 1e6",
           make::uniform_scale, field::body_scales},
    Family{2, "size-ratio", "A small body over a face of a large one.", "ratio 1 .. 1e6", make::size_ratio,
           [] { return joined(field::body_sizes(), field::triangle_sizes()); }},
    Family{3, "offset", "Both bodies far from the origin of their meshes.", "offset 1 .. 1e8", make::common_offset,
           [] { return joined(field::body_offsets(), field::triangle_offsets()); }},
    Family{4, "motion", "The same bodies in other frames, and with A and B exchanged.",
           "shift of the frames 1e-3 .. 1e3", make::rigid_motion, field::motions},
    Family{5, "kissing", "Boxes whose faces are a rounding apart, or overlap by one.", "gap 0, +-1e-16 .. 1e-3",
           make::kissing_boxes, [] { return joined(field::body_kissing(), field::triangle_kissing()); }},
    Family{6, "near-aligned", "Boxes whose faces are nearly parallel.", "angle 1e-15 .. 0.8 rad", make::near_aligned,
           field::body_aligned},
    Family{7, "parallel", "Edges and cylinders nearly parallel.", "angle 1e-15 .. 0.1 rad", make::parallel_edges,
           [] { return joined(field::body_parallel(), field::triangle_parallel()); }},
    Family{8, "slivers", "Needles and flat triangles.", "aspect 1 .. 1e8", make::slivers, field::triangle_slivers},
    Family{9, "zero-area", "Triangles without area and duplicate pairs added to a clean mesh change nothing.",
           "added triangles 0 .. 50 %", make::zero_area},
    Family{10, "retriangulated", "The same solid with many triangles on flat faces.", "12 .. 1200 triangles",
           make::retriangulated, field::retriangulations},
    Family{11, "identical", "A mesh against itself, a little shifted.", "shift 0, 1e-15 .. 1e-3", make::identical},
    Family{12, "contained", "One body inside another; depths that libraries have missed, or reported without contact.",
           "distance of the centres 0 .. 0.3", make::contained,
           [] { return joined(field::body_deep(), field::triangle_deep()); }},
    Family{13, "thin-plate", "A body on, in or just over a thin plate.", "thickness over length 1 .. 1e-6",
           make::thin_plate, field::body_thin},
    Family{14, "tunnelling", "Conservative advancement of a fast body towards a plate.",
           "step over thickness 0.1 .. 1e4", make::tunnelling, field::fast},
    Family{15, "grazing", "A corner a rounding over a face, or under it.", "gap 0, +-1e-16 .. 1e-2", make::grazing,
           field::body_grazing},
    Family{16, "holes", "Missing and flipped triangles.", "damaged triangles 0 .. 100 %", make::holes, field::damaged},
    Family{17, "bad-pose", "Invalid poses: NaN, infinity, no rotation; and extreme ones.", "norm 0 .. 1e3",
           make::bad_poses, field::inputs},
    Family{18, "lipschitz", "A distance changes by no more than the body moves.", "step 1e-12 .. 1e-3",
           make::lipschitz},
    Family{19, "closed-loop", "A conservative force does no work on a loop.", "64 .. 512 steps", make::closed_loop},
    Family{20, "repeat", "The same question again: other objects, orders and threads.", "poses 4 .. 16", make::repeated,
           field::repeats},
    Family{21, "time", "The slowest query against the median, near contact.", "triangles 200 .. 5000",
           make::worst_time},
    Family{22, "moving", "When a moving body first touches: fast, slow, spinning, grazing, at the start, never.",
           "length of the motion over the size 1e-9 .. 1e6", make::moving_bodies},
    Family{23, "contacts", "Contacts of faces, edges, corners.", "relative depth 1e-6 .. 0.05", make::contacts},
};

}  // namespace

std::span<const Family> families() { return k_families; }

const Family& find_family(std::string_view name) {
  std::string names;
  for (const Family& family : k_families) {
    if (family.name == name) return family;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", family.name);
  }
  throw BadArgument(fmt::format("{}: no such family; there are {}", name, names));
}

Genes sample_genes(const Family& family, std::uint64_t seed, std::size_t index, std::size_t count) {
  constexpr std::uint64_t k_families_apart = 1'000'003, k_samples_apart = 97;
  std::mt19937_64 random(seed * k_families_apart + static_cast<std::uint64_t>(family.number) * k_samples_apart + index);
  Genes genes;
  constexpr int k_unused_bits = 11;  // a double holds 53 of 64
  for (double& gene : genes) gene = static_cast<double>(random() >> k_unused_bits) * 0x1p-53;
  genes.front() = (static_cast<double>(index) + genes.front()) / static_cast<double>(count);
  return genes;
}

}  // namespace sixdof::stability
