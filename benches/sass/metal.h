// As much of Metal's standard library as naga's output of hexroll's kernels uses, for CUDA. Counts of machine code come of it, and
// nothing is ever run.
typedef unsigned int uint;
#define D __device__ __forceinline__

namespace metal {
typedef unsigned int uint;

struct float2 {
    float x, y;
    D float2() {}
    D float2(float x, float y) : x(x), y(y) {}
};

struct packed_float3;

struct float3 {
    float x, y, z;
    D float3() {}
    D explicit float3(float s) : x(s), y(s), z(s) {}
    D float3(float x, float y, float z) : x(x), y(y), z(z) {}
    D float3(const packed_float3& p);
    D float& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    D float operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

struct packed_float3 {
    float x, y, z;
    D packed_float3() {}
    D packed_float3(float3 v) : x(v.x), y(v.y), z(v.z) {}
};

D float3::float3(const packed_float3& p) : x(p.x), y(p.y), z(p.z) {}

struct __align__(16) float4 {
    float x, y, z, w;
    D float4() {}
    D explicit float4(float s) : x(s), y(s), z(s), w(s) {}
    D float4(float x, float y, float z, float w) : x(x), y(y), z(z), w(w) {}
    D float4(float3 v, float w) : x(v.x), y(v.y), z(v.z), w(w) {}
    D float3 xyz() const { return float3(x, y, z); }
    D float2 xy() const { return float2(x, y); }
    D float& operator[](uint i) { return (&x)[i]; }
};

struct bool3 {
    bool x, y, z;
    D bool3(bool x, bool y, bool z) : x(x), y(y), z(z) {}
};

struct uint3 {
    uint x, y, z;
    D uint3() {}
    D uint3(uint x, uint y, uint z) : x(x), y(y), z(z) {}
};

struct __align__(16) uint4 {
    uint x, y, z, w;
    D uint4() {}
    D explicit uint4(uint s) : x(s), y(s), z(s), w(s) {}
    D uint4(uint x, uint y, uint z, uint w) : x(x), y(y), z(z), w(w) {}
};

D uint4 operator+(uint4 a, uint4 b) { return uint4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }
D uint4 operator+(uint4 a, uint s) { return uint4(a.x + s, a.y + s, a.z + s, a.w + s); }

D float3 operator+(float3 a, float3 b) { return float3(a.x + b.x, a.y + b.y, a.z + b.z); }
D float3 operator-(float3 a, float3 b) { return float3(a.x - b.x, a.y - b.y, a.z - b.z); }
D float3 operator-(float3 a) { return float3(-a.x, -a.y, -a.z); }
D float3 operator*(float3 a, float s) { return float3(a.x * s, a.y * s, a.z * s); }
D float3 operator*(float s, float3 a) { return a * s; }
D float3 operator*(float3 a, float3 b) { return float3(a.x * b.x, a.y * b.y, a.z * b.z); }
D float3 operator/(float3 a, float s) { return float3(a.x / s, a.y / s, a.z / s); }
D float3 operator/(float3 a, float3 b) { return float3(a.x / b.x, a.y / b.y, a.z / b.z); }
D float4 operator+(float4 a, float4 b) { return float4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }
D float4 operator-(float4 a, float4 b) { return float4(a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w); }
D float4 operator*(float4 a, float s) { return float4(a.x * s, a.y * s, a.z * s, a.w * s); }
D float4 operator*(float s, float4 a) { return a * s; }

D float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
D float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
D float3 cross(float3 a, float3 b) {
    return float3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
D float length(float3 a) { return sqrtf(dot(a, a)); }

struct float3x3 {
    float3 c[3];
    D float3x3() {}
    D float3x3(float3 x, float3 y, float3 z) { c[0] = x; c[1] = y; c[2] = z; }
    D float3& operator[](int i) { return c[i]; }
    D const float3& operator[](int i) const { return c[i]; }
};

D float3 operator*(const float3x3& m, float3 v) { return m[0] * v.x + m[1] * v.y + m[2] * v.z; }
D float3 operator*(float3 v, const float3x3& m) { return float3(dot(v, m[0]), dot(v, m[1]), dot(v, m[2])); }
D float3x3 operator*(const float3x3& m, const float3x3& n) { return float3x3(m * n[0], m * n[1], m * n[2]); }
D float3x3 operator*(const float3x3& m, float s) { return float3x3(m[0] * s, m[1] * s, m[2] * s); }
D float3x3 operator*(float s, const float3x3& m) { return m * s; }
D float3x3 operator+(const float3x3& m, const float3x3& n) { return float3x3(m[0] + n[0], m[1] + n[1], m[2] + n[2]); }
D float3x3 operator-(const float3x3& m, const float3x3& n) { return float3x3(m[0] - n[0], m[1] - n[1], m[2] - n[2]); }
D float3x3 transpose(const float3x3& m) {
    return float3x3(float3(m[0].x, m[1].x, m[2].x), float3(m[0].y, m[1].y, m[2].y), float3(m[0].z, m[1].z, m[2].z));
}
D float determinant(const float3x3& m) { return dot(m[0], cross(m[1], m[2])); }

D float min(float a, float b) { return fminf(a, b); }
D float max(float a, float b) { return fmaxf(a, b); }
D uint min(uint a, uint b) { return ::min(a, b); }
D uint max(uint a, uint b) { return ::max(a, b); }
D float abs(float a) { return fabsf(a); }
D float sqrt(float a) { return sqrtf(a); }
D float fma(float a, float b, float c) { return fmaf(a, b, c); }
template <class T> D T select(T no, T yes, bool which) { return which ? yes : no; }
D bool all(bool3 b) { return b.x && b.y && b.z; }
D bool any(bool3 b) { return b.x || b.y || b.z; }

typedef uint atomic_uint;
enum memory_order { memory_order_relaxed };
D uint atomic_fetch_min_explicit(uint* p, uint v, memory_order) { return atomicMin(p, v); }
D uint atomic_load_explicit(const uint* p, memory_order) { return *(const volatile uint*)p; }
D void atomic_store_explicit(uint* p, uint v, memory_order) { *(volatile uint*)p = v; }

enum class mem_flags { mem_threadgroup, mem_device };
D void threadgroup_barrier(mem_flags) { __syncthreads(); }
}

template <class T, class S> D T as_type(S s) {
    static_assert(sizeof(T) == sizeof(S), "as_type");
    T t;
    memcpy(&t, &s, sizeof t);
    return t;
}
