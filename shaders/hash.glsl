// PCG (O'Neill 2014) as a hash of 32 bits. C++ compiles this file as well: src/base/hash.h.
uint hash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
