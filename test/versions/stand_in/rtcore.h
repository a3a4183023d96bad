#pragma once

/// What this project uses of Embree 3 and 4, to be compiled and not linked: the same names in headers of two names.
#define RTC_VERSION_STRING "stand-in"

using RTCDevice = struct RTCDeviceTy*;
using RTCScene = struct RTCSceneTy*;
using RTCGeometry = struct RTCGeometryTy*;

enum RTCError {
  RTC_ERROR_NONE = 0,
  RTC_ERROR_UNKNOWN = 1
};
enum RTCSceneFlags {
  RTC_SCENE_FLAG_NONE = 0,
  RTC_SCENE_FLAG_DYNAMIC = 1
};
enum RTCBuildQuality {
  RTC_BUILD_QUALITY_LOW = 0,
  RTC_BUILD_QUALITY_MEDIUM = 1,
  RTC_BUILD_QUALITY_HIGH = 2,
  RTC_BUILD_QUALITY_REFIT = 3
};
enum RTCGeometryType {
  RTC_GEOMETRY_TYPE_USER = 120
};

struct RTCBounds {
  float lower_x, lower_y, lower_z, align0;
  float upper_x, upper_y, upper_z, align1;
};
struct RTCBoundsFunctionArguments {
  void* geometryUserPtr;
  unsigned primID;
  unsigned timeStep;
  RTCBounds* bounds_o;
};
struct RTCCollision {
  unsigned geomID0, primID0, geomID1, primID1;
};

extern "C" {
RTCDevice rtcNewDevice(const char* config);
RTCError rtcGetDeviceError(RTCDevice device);
void rtcReleaseDevice(RTCDevice device);

RTCScene rtcNewScene(RTCDevice device);
void rtcSetSceneFlags(RTCScene scene, RTCSceneFlags flags);
void rtcSetSceneBuildQuality(RTCScene scene, RTCBuildQuality quality);
unsigned rtcAttachGeometry(RTCScene scene, RTCGeometry geometry);
void rtcCommitScene(RTCScene scene);
void rtcReleaseScene(RTCScene scene);

RTCGeometry rtcNewGeometry(RTCDevice device, RTCGeometryType type);
void rtcSetGeometryBuildQuality(RTCGeometry geometry, RTCBuildQuality quality);
void rtcSetGeometryUserPrimitiveCount(RTCGeometry geometry, unsigned count);
void rtcSetGeometryUserData(RTCGeometry geometry, void* data);
void rtcSetGeometryBoundsFunction(RTCGeometry geometry, void (*bounds)(const RTCBoundsFunctionArguments*), void* data);
void rtcCommitGeometry(RTCGeometry geometry);
void rtcReleaseGeometry(RTCGeometry geometry);

void rtcCollide(RTCScene a, RTCScene b, void (*receive)(void*, RTCCollision*, unsigned), void* data);
}
