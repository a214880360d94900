// One reader a format; read_volume (volume_file.cpp) chooses among them and finishes what they return.
#pragma once
#include "host/io/volume/volume_file.hpp"

namespace clvr {

/// Each checks its container, decodes, and sets everything of Voxels but `repaired`. All throw Error{input}.
Voxels read_nifti(const std::string& path, const VolumeReadOptions& options);
Voxels read_nrrd(const std::string& path, const VolumeReadOptions& options);
Voxels read_metaimage(const std::string& path, const VolumeReadOptions& options);
Voxels read_vtk(const std::string& path, const VolumeReadOptions& options);
Voxels read_vti(const std::string& path, const VolumeReadOptions& options);
Voxels read_numpy(const std::string& path, const VolumeReadOptions& options);
Voxels read_mrc(const std::string& path, const VolumeReadOptions& options);
Voxels read_mgh(const std::string& path, const VolumeReadOptions& options);
/// A file, or FILE:/path/of/dataset.
Voxels read_hdf5(const std::string& path, const VolumeReadOptions& options);
Voxels read_raw(const std::string& path, const VolumeReadOptions& options);
/// One file of several pages, or the slices of a stack in order.
Voxels read_tiff(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options);
/// PNG or JPEG pictures of grey values: one slice, or the slices of a stack in order.
Voxels read_png_slices(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options);
Voxels read_jpeg_slices(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options);
/// The series of one file among its neighbours, or of a folder.
Voxels read_dicom(const std::string& path, const VolumeReadOptions& options);

} // namespace clvr
