// Vectors of a 3D scene, metres.
#pragma once

#include <cmath>

namespace lensprof {

constexpr double kPi = 3.14159265358979323846;

struct Vector3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

inline Vector3 operator+(const Vector3 &a, const Vector3 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector3 operator-(const Vector3 &a, const Vector3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector3 operator*(double k, const Vector3 &a) { return {k * a.x, k * a.y, k * a.z}; }

inline double dot(const Vector3 &a, const Vector3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline Vector3 cross(const Vector3 &a, const Vector3 &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Vector3 normalised(const Vector3 &a) { return 1.0 / std::sqrt(dot(a, a)) * a; }

}  // namespace lensprof
