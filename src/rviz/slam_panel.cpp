#include "slam_panel.h"

#include <scan_image_slam/SaveMap.h>
#include <scan_image_slam/StateFile.h>

#include <QGridLayout>
#include <chrono>
#include <thread>
#include <utility>

#include <pluginlib/class_list_macros.hpp>
#include <ros/service_client.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

namespace scan_image_slam {
namespace {

constexpr int kRefreshPeriod = 100;   // [ms]
constexpr int kResetPatience = 4000;  // within which the second click has to follow [ms]
constexpr int kPatience = 3000;       // after which a service is told to be slow [ms]

/// Text of an answer of save_map and save_state.
const auto kFileText = [](const auto& response) {
  return response.success ? "written: " + response.path : response.message;
};
const auto kMessage = [](const auto& response) { return response.message; };

/// Runs it in a thread that nobody waits for: who does not answer keeps no window from closing.
template <typename Answer>
std::future<Answer> InBackground(std::function<Answer()> call) {
  std::packaged_task<Answer()> task(std::move(call));
  std::future<Answer> answer = task.get_future();
  std::thread(std::move(task)).detach();
  return answer;
}

}  // namespace

SlamPanel::SlamPanel(QWidget* parent)
    : rviz::Panel(parent),
      status_(node_.getNamespace()),
      name_(new QLineEdit("map", this)),
      save_map_(AddButton("save_map", "Save map",
                          "Writes NAME.pgm and NAME.yaml for map_server into mapper/map_folder")),
      save_state_(AddButton("save_state", "Save state",
                            "Writes NAME.state, with which mapping or localization can go on")),
      pause_(AddButton("pause", "Pause mapping",
                       "Leaves the map as it is; pose and transforms go on")),
      reset_(AddButton("reset", "Reset map",
                       "Map and pose start over; in localization the pose alone")),
      activity_(AddLabel("activity")),
      problems_(AddLabel("problems")),
      answer_(AddLabel("answer")) {
  name_->setObjectName("name");
  name_->setToolTip("Name of the files to be written, within mapper/map_folder");
  Arrange();
  connect(name_, &QLineEdit::textEdited, this, [this] { Q_EMIT configChanged(); });
  connect(save_map_, &QPushButton::clicked, this, [this] { SaveMap(); });
  connect(save_state_, &QPushButton::clicked, this, [this] { SaveState(); });
  connect(pause_, &QPushButton::clicked, this, [this] { Pause(); });
  connect(reset_, &QPushButton::clicked, this, [this] { Reset(); });
  reset_timer_.setSingleShot(true);
  connect(&reset_timer_, &QTimer::timeout, this, [this] { CalmReset(); });
  connect(&refresh_timer_, &QTimer::timeout, this, [this] { Refresh(); });
  refresh_timer_.start(kRefreshPeriod);
  // rviz calls back in the thread of its windows.
  diagnostics_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 20, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
        status_.Take(*message, ros::WallTime::now());
      });
  Refresh();
}

QPushButton* SlamPanel::AddButton(const char* name, const char* text, const char* help) {
  auto* button = new QPushButton(text, this);
  button->setObjectName(name);
  button->setToolTip(help);
  return button;
}

QLabel* SlamPanel::AddLabel(const char* name) {
  auto* label = new QLabel(this);
  label->setObjectName(name);
  label->setTextFormat(Qt::PlainText);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  label->setWordWrap(true);
  return label;
}

void SlamPanel::Arrange() {
  auto* grid = new QGridLayout(this);
  grid->addWidget(new QLabel("Name", this), 0, 0);
  grid->addWidget(name_, 0, 1);
  grid->addWidget(save_map_, 0, 2);
  grid->addWidget(save_state_, 0, 3);
  grid->addWidget(pause_, 1, 0, 1, 2);
  grid->addWidget(reset_, 1, 2, 1, 2);
  int row = 2;
  for (QLabel* label : {activity_, problems_, answer_}) grid->addWidget(label, row++, 0, 1, 4);
  grid->setRowStretch(row, 1);
  QFont bold = activity_->font();
  bold.setBold(true);
  activity_->setFont(bold);
  problems_->setStyleSheet("color: #a04000");
}

/// Asks in the background; what `text` makes of the response is shown when it has come.
template <typename Service, typename Text>
void SlamPanel::Call(const std::string& name, const Service& service, const Text& text) {
  ros::ServiceClient client = node_.serviceClient<Service>(name);
  called_ = client.getService();
  awaited_ = InBackground<Answer>([client, service = service, text]() mutable -> Answer {
    if (!client.exists()) {
      return {false, "nobody offers this service: start the mapper, or rviz in its namespace"};
    }
    if (!client.call(service)) {
      return {false, "the mapper has not answered: see its console, and whether it still runs"};
    }
    return {service.response.success != 0, text(service.response)};
  });
  awaited_since_.start();
  Enable(false);
  ShowAnswer(true, "...");
}

void SlamPanel::SaveMap() {
  scan_image_slam::SaveMap service;
  service.request.name = name_->text().toStdString();
  Call("save_map", service, kFileText);
}

void SlamPanel::SaveState() {
  StateFile service;
  const std::string name = name_->text().toStdString();
  service.request.path = name.empty() ? name : name + ".state";
  Call("save_state", service, kFileText);
}

void SlamPanel::Pause() {
  std_srvs::SetBool service;
  service.request.data = !status_.paused();
  Call("pause", service, kMessage);
}

/// A map is quickly lost: only a second click counts.
void SlamPanel::Reset() {
  if (!reset_timer_.isActive()) {
    reset_->setText("Really reset?");
    reset_timer_.start(kResetPatience);
    return;
  }
  CalmReset();
  Call("reset", std_srvs::Trigger(), kMessage);
}

void SlamPanel::CalmReset() {
  reset_timer_.stop();
  reset_->setText("Reset map");
}

void SlamPanel::Refresh() {
  const ros::WallTime now = ros::WallTime::now();
  activity_->setText(QString::fromStdString(status_.Activity(now)));
  const std::string problems = status_.Problems(now);
  problems_->setText(QString::fromStdString(problems));
  problems_->setVisible(!problems.empty());
  pause_->setText(status_.paused() ? "Resume mapping" : "Pause mapping");
  if (!awaited_.valid()) return;
  if (awaited_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    const Answer answer = awaited_.get();
    ShowAnswer(answer.success, answer.text);
    Enable(true);
  } else if (awaited_since_.hasExpired(kPatience)) {
    ShowAnswer(false, "no answer yet: is the mapper busy, or does it hang?");
    Enable(true);  // the others may do better
  }
}

void SlamPanel::ShowAnswer(bool success, const std::string& text) {
  answer_->setStyleSheet(success ? "" : "color: #b00000");
  answer_->setText(QString::fromStdString(called_ + ": " + text));
}

void SlamPanel::Enable(bool enabled) {
  for (QPushButton* button : {save_map_, save_state_, pause_, reset_}) {
    button->setEnabled(enabled);
  }
}

void SlamPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString name;
  if (config.mapGetString("File Name", &name)) name_->setText(name);
}

void SlamPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("File Name", name_->text());
}

}  // namespace scan_image_slam

PLUGINLIB_EXPORT_CLASS(scan_image_slam::SlamPanel, rviz::Panel)
