// Any program: at its first dispatch a driver loads and sets up its compiler (Device::Device).
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Values { float value; };

void main() { value = sin(value); }
