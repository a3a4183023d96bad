#pragma once

/// What this project uses of MuJoCo, to be compiled and not linked. Included by the header of a version, which defines
/// mjVERSION_HEADER and mjVFS.
struct mjModel {
  int nmeshvert;
};
struct mjData {
  double* qpos;
  int ncon;
};

extern "C" {
extern void (*mju_user_error)(const char*);
extern void (*mju_user_warning)(const char*);
const char* mj_versionString();

void mj_defaultVFS(mjVFS* files);
void mj_deleteVFS(mjVFS* files);

mjModel* mj_loadXML(const char* name, const mjVFS* files, char* error, int error_size);
void mj_deleteModel(mjModel* model);
int mj_sizeModel(const mjModel* model);
mjData* mj_makeData(const mjModel* model);
void mj_deleteData(mjData* data);

void mj_kinematics(const mjModel* model, mjData* data);
void mj_comPos(const mjModel* model, mjData* data);
void mj_collision(const mjModel* model, mjData* data);
}
