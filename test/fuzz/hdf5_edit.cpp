#include "hdf5_edit.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <vector>

#include <sixdof/base/hdf5.h>

namespace sixdof::fuzz {
namespace {

using hdf5::Handle;

herr_t add_name(hid_t, const char* name, const H5O_info_t*, void* list) {
  static_cast<std::vector<std::string>*>(list)->emplace_back(name);
  return 0;
}

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* list) {
  static_cast<std::vector<std::string>*>(list)->emplace_back(name);
  return 0;
}

std::string pick(const std::vector<std::string>& names, Input& input) {
  return names.empty() ? "none" : names[input.byte() % names.size()];
}

hid_t pick_type(Input& input) {
  const std::array types{H5T_STD_I32LE,  H5T_STD_U32LE,  H5T_STD_U64LE, H5T_IEEE_F32LE,
                         H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_STD_I8LE};
  return types[input.byte() % types.size()];
}

void write_attribute(hid_t object, const std::string& name, Input& input) {
  H5Adelete(object, name.c_str());
  const std::size_t length = input.byte() % 64;
  const bool is_text = length != 0;
  const Handle type(is_text ? H5Tcopy(H5T_C_S1) : H5Tcopy(pick_type(input)), H5Tclose);
  if (is_text) H5Tset_size(type.id(), length);
  std::string value(input.bytes(std::max<std::size_t>(length, 8)));
  value.resize(std::max<std::size_t>(length, 8));
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute.id(), type.id(), value.data());
}

/// A size that is small, or so large that no memory holds it.
hsize_t pick_size(Input& input) {
  const unsigned size = input.byte();
  constexpr unsigned k_shifted = 192;
  return size < k_shifted ? size % 32 : hsize_t{1} << (size - k_shifted);
}

/// A dataset of another size; without values where it is large.
void replace_dataset(hid_t file, const std::string& name, Input& input) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const hid_t type = pick_type(input);
  const std::array<hsize_t, 2> size{pick_size(input), pick_size(input)};
  const Handle space(H5Screate_simple(1 + input.byte() % 2, size.data(), nullptr), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const bool small = size[0] <= 32 && size[1] <= 32;
  if (input.byte() % 2 != 0 || !small) {
    const std::array<hsize_t, 2> chunk{std::clamp<hsize_t>(size[0], 1, 32), std::clamp<hsize_t>(size[1], 1, 32)};
    H5Pset_chunk(properties.id(), H5Sget_simple_extent_ndims(space.id()), chunk.data());
  }
  const Handle dataset(H5Dcreate2(file, name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                       H5Dclose);
  if (!small) return;
  std::array<std::uint64_t, 32 * 32> values{};
  for (std::uint64_t& value : values) {
    if (input.empty()) break;
    value = input.word();
  }
  H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void edit(hid_t file, Input& input) {
  std::vector<std::string> objects, attributes;
#if H5_VERSION_GE(1, 12, 0)
  H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_INC, add_name, &objects, H5O_INFO_BASIC);
#else
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add_name, &objects);
#endif
  const std::string name = pick(objects, input);
  const Handle object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose);
  if (object.id() >= 0) {
    H5Aiterate2(object.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &attributes);
  }
  switch (input.byte() % 6) {
    case 0:
      H5Adelete(object.id(), pick(attributes, input).c_str());
      return;
    case 1:
    case 2:
      write_attribute(object.id(), pick(attributes, input), input);
      return;
    case 3:
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      return;
    case 4:
      replace_dataset(file, name, input);
      return;
    default:
      H5Lmove(file, name.c_str(), file, std::string(input.bytes(input.byte() % 16)).c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
}

/// Bytes changed, inserted or cut off.
void damage_bytes(std::string& bytes, Input& input) {
  while (!input.empty() && !bytes.empty()) {
    const unsigned what = input.byte();
    const std::size_t at = (input.byte() | std::size_t{input.byte()} << 8) % bytes.size();
    if (what < 240) {
      bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(input.byte()));
    } else if (what < 248) {
      bytes.resize(at);
    } else {
      bytes.insert(at, input.bytes(input.byte()));
    }
  }
}

}  // namespace

void damage_hdf5(const std::filesystem::path& file, Input& input) {
  if (input.byte() % 2 == 0) {
    std::string bytes = read_bytes(file);
    damage_bytes(bytes, input);
    write_bytes(file, bytes);
    return;
  }
  const hdf5::Session session;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDWR, access.id()), H5Fclose);
  constexpr int k_most_edits = 8;
  for (int i = 0; i < k_most_edits && !input.empty(); ++i) edit(opened.id(), input);
}

}  // namespace sixdof::fuzz
