#include "scan_image_slam/core/simulation/random_stream.h"
#include "textures.h"

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

cv::Scalar RandomColour(RandomStream& random, double low, double high) {
  const double blue = random.Uniform(low, high);
  const double green = random.Uniform(low, high);
  return {blue, green, random.Uniform(low, high)};
}

void Fill(cv::Mat& image, const cv::Rect& rect, const cv::Scalar& colour) {
  cv::rectangle(image, rect & cv::Rect({0, 0}, image.size()), colour, cv::FILLED);
}

/// Lines of words.
void DrawText(cv::Mat& image, const cv::Rect& area, int line_height, const cv::Scalar& ink,
              RandomStream& random) {
  for (int y = area.y; y + line_height <= area.br().y; y += line_height) {
    int x = area.x;
    while (true) {
      const int word = line_height + static_cast<int>(random.Index(4 * line_height));
      if (x + word > area.br().x) break;
      Fill(image, {x, y, word, line_height / 2}, ink);
      x += word + line_height / 2;
    }
  }
}

/// A photograph or a diagram: a dark or light ground with discs and bars.
void DrawFigure(cv::Mat& image, const cv::Rect& area, RandomStream& random) {
  Fill(image, area, RandomColour(random, 40, 220));
  const int shapes = 3 + static_cast<int>(random.Index(5));
  for (int i = 0; i < shapes; ++i) {
    const cv::Scalar colour = RandomColour(random, 20, 240);
    const int x = area.x + static_cast<int>(random.Index(area.width));
    const int y = area.y + static_cast<int>(random.Index(area.height));
    const int size = area.height / 8 + static_cast<int>(random.Index(area.height / 3 + 1));
    cv::Mat inside = image(area);
    if (random.Uniform() < 0.5) {
      cv::circle(inside, cv::Point(x, y) - area.tl(), size / 2, colour, cv::FILLED, cv::LINE_AA);
    } else {
      Fill(inside, {x - area.x, y - area.y, size / 2, area.height}, colour);
    }
  }
}

void DrawSheet(cv::Mat& image, const cv::Rect& area, int line_height, RandomStream& random) {
  Fill(image, area, RandomColour(random, 195, 255));
  const cv::Scalar ink = RandomColour(random, 10, 90);
  const int margin = area.width / 12 + 1;
  const cv::Rect inner(area.x + margin, area.y + margin, area.width - 2 * margin,
                       area.height - 2 * margin);
  const int title = inner.height / 7;
  const int figure = inner.height * (2 + static_cast<int>(random.Index(3))) / 8;
  Fill(image,
       {inner.x, inner.y, inner.width * (5 + static_cast<int>(random.Index(4))) / 8, title / 2},
       ink);
  if (figure > 8) DrawFigure(image, {inner.x, inner.y + title, inner.width, figure}, random);
  const int text = inner.y + title + figure + line_height;
  DrawText(image, {inner.x, text, inner.width, inner.br().y - text}, line_height, ink, random);
}

cv::Mat DrawPoster(RandomStream& random) {
  cv::Mat image(kPictureSize, kPictureSize, CV_8UC3);
  DrawSheet(image, {0, 0, image.cols, image.rows}, 8, random);
  return image;
}

cv::Mat DrawNoticeBoard(RandomStream& random) {
  cv::Mat image(kPictureSize, kPictureSize, CV_8UC3, cv::Scalar(90, 128, 170));
  const int columns = 4 + static_cast<int>(random.Index(4));
  const int pitch = kPictureSize / columns;
  for (int x = 0; x + pitch <= kPictureSize; x += pitch) {
    for (int y = 0; y + 85 <= kPictureSize; y += 85) {
      if (random.Uniform() < 0.25) continue;
      const int width = pitch * 6 / 10 + static_cast<int>(random.Index(pitch / 4 + 1));
      const int height = 50 + static_cast<int>(random.Index(25));
      const int dx = static_cast<int>(random.Index(pitch - width));
      const int dy = static_cast<int>(random.Index(85 - height));
      DrawSheet(image, {x + dx, y + dy, width, height}, 5, random);
    }
  }
  return image;
}

/// Sky above trees and houses.
cv::Mat DrawWindowView(RandomStream& random) {
  cv::Mat image(kPictureSize, kPictureSize, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    const double f = static_cast<double>(y) / image.rows;
    image.row(y) = cv::Scalar(252 - 10 * f, 242 - 6 * f, 226 + 12 * f);
  }
  for (int i = 0; i < 4; ++i) {
    const int top = 110 + static_cast<int>(random.Index(80));
    const int left = static_cast<int>(random.Index(kPictureSize));
    const int width = 30 + static_cast<int>(random.Index(60));
    Fill(image, {left, top, width, kPictureSize - top}, RandomColour(random, 130, 200));
  }
  for (int i = 0; i < 12; ++i) {
    const int x = static_cast<int>(random.Index(kPictureSize));
    const int y = 200 + static_cast<int>(random.Index(70));
    const int radius = 20 + static_cast<int>(random.Index(25));
    const double green = random.Uniform(90, 140);
    cv::circle(image, {x, y}, radius, cv::Scalar(0.5 * green, green, 0.7 * green), cv::FILLED,
               cv::LINE_AA);
  }
  return image;
}

}  // namespace

cv::Mat DrawPicture(const PictureSpec& spec) {
  RandomStream random(spec.seed, "picture");
  switch (spec.kind) {
    case PictureSpec::Kind::kNoticeBoard:
      return DrawNoticeBoard(random);
    case PictureSpec::Kind::kWindowView:
      return DrawWindowView(random);
    case PictureSpec::Kind::kPoster:
      break;
  }
  return DrawPoster(random);
}

}  // namespace scan_image_slam
