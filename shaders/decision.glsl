// What was decided for a pixel: nothing seen, interpolate, or shade with the share of samples that its bin deserves. A validation pixel is
// shaded although it might be interpolated: what interpolation would have given there is held against what shading gives.
const uint nothing_seen = 0u, interpolate_it = 1u, first_bin = 2u, validation_bit = 128u;

bool is_shaded(uint decision) { return (decision & ~validation_bit) >= first_bin; }
bool is_validation(uint decision) { return (decision & validation_bit) != 0u; }
uint bin_of(uint decision) { return (decision & ~validation_bit) - first_bin; }
