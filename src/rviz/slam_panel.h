#pragma once

#include "slam_status.h"

#include <QElapsedTimer>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>
#include <functional>
#include <future>
#include <string>

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rviz/panel.h>

namespace scan_image_slam {

/// Panel of rviz: saves, pauses and resets the map by the services of the mapper, and shows how the
/// nodes are from /diagnostics. Names are relative to the namespace of rviz, as those of displays.
class SlamPanel : public rviz::Panel {
 public:
  explicit SlamPanel(QWidget* parent = nullptr);
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  struct Answer {
    bool success = false;
    std::string text;
  };
  QPushButton* AddButton(const char* name, const char* text, const char* help);
  QLabel* AddLabel(const char* name);
  void Arrange();
  template <typename Service, typename Text>
  void Call(const std::string& name, const Service& service, const Text& text);
  void SaveMap();
  void SaveState();
  void Pause();
  void Reset();
  void CalmReset();
  void Refresh();
  void ShowAnswer(bool success, const std::string& text);
  void Enable(bool enabled);

  ros::NodeHandle node_;
  SlamStatus status_;
  QLineEdit* name_;
  QPushButton* save_map_;
  QPushButton* save_state_;
  QPushButton* pause_;
  QPushButton* reset_;
  QLabel* activity_;
  QLabel* problems_;
  QLabel* answer_;
  QTimer refresh_timer_;
  QTimer reset_timer_;           ///< runs while a second click on reset counts
  std::string called_;           ///< full name of the service that was called last
  std::future<Answer> awaited_;  ///< valid until it has answered
  QElapsedTimer awaited_since_;
  ros::Subscriber diagnostics_;
};

}  // namespace scan_image_slam
