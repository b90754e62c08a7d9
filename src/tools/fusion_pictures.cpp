#include "fusion_pictures.h"

#include "picture_file.h"
#include "scan_image_slam/core/pipeline/fusion_picture.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace scan_image_slam {

void FusionPictures::Add(const ScanImageFusion& fusion, const PipelineResult& result) {
  if (!result.model.has_image) return;
  const bool keep = options_.every > 0 && fused_++ % options_.every == 0;
  if (!keep && options_.video.empty()) return;
  const cv::Mat picture = DrawFusion(fusion, result.model, &result.match);
  if (keep) {
    std::ostringstream name;
    name << folder_ << "/fusion_" << std::setw(6) << std::setfill('0') << fused_ << ".png";
    WritePicture(name.str(), picture);
  }
  if (!options_.video.empty()) AddToVideo(fusion.evidence().image.stamp, picture);
}

void FusionPictures::AddToVideo(Stamp stamp, const cv::Mat& picture) {
  if (!first_stamp_) {
    first_stamp_ = stamp;
    first_picture_ = picture;
    return;
  }
  if (!video_.isOpened()) {
    constexpr double kHighestRate = 120.0;  // [Hz]
    const double rate = std::round(1.0 / Seconds(stamp - *first_stamp_));
    const bool opened = video_.open(options_.video, cv::CAP_OPENCV_MJPEG,
                                    cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                                    std::clamp(rate, 1.0, kHighestRate), picture.size());
    if (!opened) {
      throw std::runtime_error("can't write the film " + options_.video +
                               ": its name must end with .avi, and its folder must be there");
    }
    video_.write(first_picture_);
  }
  video_.write(picture);
}

}  // namespace scan_image_slam
