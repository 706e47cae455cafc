// Pixels that are shaded whatever is decided for others, drawn by chance: src/passes/uniforms.h, Witnesses. How many of 2^32 beside the
// first; 0: none.
uniform uint witnesses, witness_seed, audited, audit_seed;

bool is_drawn(ivec2 at, uint part, uint seed) { return part > 0u && hash((uint(at.y) << 16 | uint(at.x)) ^ hash(seed)) <= part; }
bool is_chosen(ivec2 at) { return is_drawn(at, witnesses, witness_seed) || is_drawn(at, audited, audit_seed); }
