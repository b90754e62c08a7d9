// The panel of rviz as rviz loads it, with services and diagnostics made here.

#include <scan_image_slam/SaveMap.h>
#include <scan_image_slam/StateFile.h>

#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <atomic>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <pluginlib/class_loader.hpp>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <rviz/panel.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

namespace scan_image_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// Does what rviz does in its thread until the condition holds; false after twenty seconds.
bool RunUntil(const std::function<bool()>& condition) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
  while (!condition() && ros::WallTime::now() < deadline) {
    QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return condition();
}

class SlamPanel : public testing::Test {
 protected:
  SlamPanel() : loader_("rviz", "rviz::Panel") {
    node_.setCallbackQueue(&queue_);
    spinner_.start();
    panel_.reset(loader_.createUnmanagedInstance("scan_image_slam/SlamPanel"));
  }
  ~SlamPanel() override {
    panel_.reset();
    spinner_.stop();
  }

  template <typename Service>
  using Handler = std::function<bool(typename Service::Request&, typename Service::Response&)>;

  /// A service in a thread of its own, as if it were in another process.
  template <typename Service>
  void Offer(const std::string& name, const Handler<Service>& handler) {
    services_.push_back(
        node_.advertiseService<typename Service::Request, typename Service::Response>(name,
                                                                                      handler));
  }

  QPushButton* Button(const char* name) const {
    auto* button = panel_->findChild<QPushButton*>(name);
    if (button == nullptr) throw std::runtime_error(std::string("there is no button ") + name);
    return button;
  }

  std::string Text(const char* label) const {
    return panel_->findChild<QLabel*>(label)->text().toStdString();
  }

  /// Whether a label comes to hold a text.
  testing::AssertionResult Shows(const char* label, const std::string& text) {
    if (RunUntil([&] { return Text(label).find(text) != std::string::npos; })) {
      return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << label << " shows: " << Text(label);
  }

  void Diagnose(const std::string& name, unsigned char level, const std::string& message,
                const std::vector<std::pair<std::string, std::string>>& values = {}) {
    if (!diagnostics_) {
      diagnostics_ = node_.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
    }
    ASSERT_TRUE(RunUntil([&] { return diagnostics_.getNumSubscribers() > 0; }));
    diagnostic_msgs::DiagnosticArray array;
    array.status.resize(1);
    array.status[0].name = name;
    array.status[0].level = level;
    array.status[0].message = message;
    for (const auto& [key, value] : values) {
      array.status[0].values.emplace_back();
      array.status[0].values.back().key = key;
      array.status[0].values.back().value = value;
    }
    diagnostics_.publish(array);
  }

  pluginlib::ClassLoader<rviz::Panel> loader_;
  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
  ros::Publisher diagnostics_;
  std::deque<ros::ServiceServer> services_;
  std::unique_ptr<rviz::Panel> panel_;
};

TEST_F(SlamPanel, NamesTheServiceThatIsAbsentAndGoesOn) {
  for (const char* name : {"save_map", "save_state", "pause"}) {
    Button(name)->click();
    EXPECT_FALSE(Button(name)->isEnabled());
    EXPECT_TRUE(Shows("answer", std::string("/") + name + ": nobody offers this service"));
    EXPECT_TRUE(Button(name)->isEnabled());
  }
}

TEST_F(SlamPanel, SavesMapAndStateUnderTheNameAndShowsWhere) {
  Offer<SaveMap>("save_map", [](SaveMap::Request& request, SaveMap::Response& response) {
    response.success = true;
    response.path = "/maps/" + request.name + ".yaml";
    return true;
  });
  Offer<StateFile>("save_state", [](StateFile::Request& request, StateFile::Response& response) {
    response.success = true;
    response.path = "/maps/" + request.path;
    return true;
  });
  panel_->findChild<QLineEdit*>("name")->setText("office");
  Button("save_map")->click();
  EXPECT_TRUE(Shows("answer", "/save_map: written: /maps/office.yaml"));
  Button("save_state")->click();
  EXPECT_TRUE(Shows("answer", "/save_state: written: /maps/office.state"));
}

TEST_F(SlamPanel, ShowsWhyAServiceDidNotSucceed) {
  Offer<SaveMap>("save_map", [](SaveMap::Request&, SaveMap::Response& response) {
    response.message = "there is no map yet";
    return true;
  });
  Button("save_map")->click();
  EXPECT_TRUE(Shows("answer", "/save_map: there is no map yet"));
}

TEST_F(SlamPanel, TellsThatAServiceFailed) {
  Offer<SaveMap>("save_map", [](SaveMap::Request&, SaveMap::Response&) { return false; });
  Button("save_map")->click();
  EXPECT_TRUE(Shows("answer", "/save_map: the mapper has not answered"));
}

TEST_F(SlamPanel, RunsOnWhileAServiceHangs) {
  std::promise<void> end;
  Offer<SaveMap>("save_map", [&](SaveMap::Request&, SaveMap::Response& response) {
    end.get_future().wait();  // for ever, if the panel waits for it
    response.success = true;
    response.path = "/late.yaml";
    return true;
  });
  Button("save_map")->click();
  EXPECT_TRUE(Shows("answer", "no answer yet"));
  EXPECT_TRUE(Button("pause")->isEnabled());
  end.set_value();
  EXPECT_TRUE(Shows("answer", "/late.yaml"));
}

TEST_F(SlamPanel, ClosesWhileAServiceHangs) {
  std::promise<void> begin;
  std::promise<void> end;
  Offer<SaveMap>("save_map", [&](SaveMap::Request&, SaveMap::Response&) {
    begin.set_value();
    end.get_future().wait();
    return true;
  });
  Button("save_map")->click();
  begin.get_future().wait();
  panel_.reset();  // waits for ever, if the panel waits for its answer
  end.set_value();
}

TEST_F(SlamPanel, PausesAndResumes) {
  std::deque<bool> asked;
  Offer<std_srvs::SetBool>(
      "pause", [&](std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
        asked.push_back(request.data);
        response.success = true;
        response.message = request.data ? "paused" : "goes on";
        return true;
      });
  QPushButton* button = Button("pause");
  EXPECT_EQ(button->text(), "Pause mapping");
  button->click();
  EXPECT_TRUE(Shows("answer", "/pause: paused"));
  Diagnose("mapper: inputs", DiagnosticStatus::OK, "working",
           {{"mode", "mapping"}, {"paused", "yes"}});
  EXPECT_TRUE(RunUntil([&] { return button->text() == "Resume mapping"; }));
  EXPECT_TRUE(Shows("activity", "mapping (paused)"));
  button->click();
  EXPECT_TRUE(Shows("answer", "/pause: goes on"));
  Diagnose("mapper: inputs", DiagnosticStatus::OK, "working",
           {{"mode", "mapping"}, {"paused", "no"}});
  EXPECT_TRUE(RunUntil([&] { return button->text() == "Pause mapping"; }));
  EXPECT_EQ(asked, (std::deque<bool>{true, false}));
}

TEST_F(SlamPanel, ResetsAtTheSecondClickOnly) {
  std::atomic<int> resets{0};
  Offer<std_srvs::Trigger>("reset",
                           [&](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
                             ++resets;
                             response.success = true;
                             response.message = "starts over";
                             return true;
                           });
  QPushButton* button = Button("reset");
  button->click();
  EXPECT_EQ(button->text(), "Really reset?");
  // Who thinks better of it is left alone.
  EXPECT_TRUE(RunUntil([&] { return button->text() == "Reset map"; }));
  button->click();
  EXPECT_EQ(resets, 0);
  button->click();
  EXPECT_TRUE(Shows("answer", "/reset: starts over"));
  EXPECT_EQ(button->text(), "Reset map");
  EXPECT_EQ(resets, 1);
}

TEST_F(SlamPanel, ShowsWhatTheNodesSayAndThatTheyAreSilent) {
  EXPECT_TRUE(Shows("activity", "no mapper is heard"));
  EXPECT_TRUE(Shows("problems", "scan_image_fusion: says nothing"));
  Diagnose("mapper: inputs", DiagnosticStatus::OK, "working",
           {{"mode", "mapping"}, {"paused", "no"}});
  // Others are not meant: neither another robot nor another part of this one.
  Diagnose("robot2/mapper: inputs", DiagnosticStatus::OK, "working", {{"mode", "lost"}});
  Diagnose("base: motors", DiagnosticStatus::ERROR, "hot");
  Diagnose("scan_image_fusion: inputs", DiagnosticStatus::WARN, "waiting for topic /image_raw");
  Diagnose("bounded_icp: inputs", DiagnosticStatus::OK, "working", {{"mode", "no_camera"}});
  EXPECT_TRUE(RunUntil([&] { return Text("activity") == "mapping; sensors: no_camera"; }))
      << Text("activity");
  EXPECT_EQ(Text("problems"), "scan_image_fusion: waiting for topic /image_raw");
  // They come every second: after some, the node is gone.
  EXPECT_TRUE(Shows("activity", "no mapper is heard"));
}

TEST_F(SlamPanel, KeepsTheNameInTheLayout) {
  panel_->findChild<QLineEdit*>("name")->setText("hall");
  rviz::Config config;
  panel_->save(config);
  const std::unique_ptr<rviz::Panel> other(
      loader_.createUnmanagedInstance("scan_image_slam/SlamPanel"));
  other->load(config);
  EXPECT_EQ(other->findChild<QLineEdit*>("name")->text(), "hall");
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "slam_panel_test");
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
